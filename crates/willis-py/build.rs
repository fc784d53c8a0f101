//! Folds functions of the same code where the project builds its wheels: they are a few percent smaller for it.

fn main() {
    let of = |key: &str| std::env::var(key).unwrap_or_default();
    // Rust's own linker knows how; others may not, so that it is asked for. Nothing here compares addresses of functions, which
    // Rust does not promise to be different; what says so for itself (`safe`) is three percent less.
    if !of("WILLIS_WHEEL").is_empty()
        && of("CARGO_CFG_TARGET_OS") == "linux"
        && of("CARGO_CFG_TARGET_ENV") == "gnu"
        && of("CARGO_CFG_TARGET_ARCH") == "x86_64"
    {
        println!("cargo:rustc-cdylib-link-arg=-Wl,--icf=all");
    }
    println!("cargo:rerun-if-env-changed=WILLIS_WHEEL");
    println!("cargo:rerun-if-changed=build.rs");
}
