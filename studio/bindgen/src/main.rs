//! Writes the JavaScript and the types for `willis_web.wasm`: `willis-bindgen FILE.wasm FOLDER`. With `--pack` the WebAssembly is
//! packed with LZMA, which `studio/unpack` unpacks.
//!
//! No address of the WebAssembly is written into the script: the page says where it is, so that it can be within the page.

use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::ExitCode;

use lzma_rust2::{LzmaOptions, LzmaWriter};

use wasm_bindgen_cli_support::Bindgen;

fn main() -> ExitCode {
    // The first word is the program itself.
    let mut words: Vec<String> = std::env::args().skip(1).collect();
    let packs = words.last().is_some_and(|w| w == "--pack");
    if packs {
        words.pop();
    }
    let [input, folder] = words.as_slice() else {
        eprintln!("usage: willis-bindgen FILE.wasm FOLDER [--pack]");
        return ExitCode::FAILURE;
    };
    let written = Bindgen::new()
        .input_path(input)
        .web(true)
        .and_then(|b| b.omit_default_module_path(true).typescript(true).remove_name_section(true).generate(folder));
    let done = written.map_err(|wrong| format!("{wrong:#}")).and_then(|()| match packs {
        true => pack(input, folder).map_err(|wrong| wrong.to_string()),
        false => Ok(()),
    });
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(wrong) => {
            eprintln!("{wrong}");
            ExitCode::FAILURE
        }
    }
}

/// Packs what was written for a module, and takes the plain one away: nothing else reads it, and a bundler would take it for a file
/// of the page.
fn pack(input: &str, folder: &str) -> std::io::Result<()> {
    let name = Path::new(input).file_stem().unwrap_or_default().to_string_lossy();
    let plain = Path::new(folder).join(format!("{name}_bg.wasm"));
    let bytes = fs::read(&plain)?;
    // Instructions have any length, so their place says nothing; the whole byte before them does.
    let mut options = LzmaOptions::with_preset(9);
    options.dict_size = bytes.len().next_power_of_two() as u32;
    (options.lc, options.lp, options.pb, options.nice_len) = (8, 0, 0, 273);
    let mut packed = LzmaWriter::new_use_header(Vec::new(), &options, Some(bytes.len() as u64))?;
    packed.write_all(&bytes)?;
    fs::write(plain.with_extension("wasm.lzma"), packed.finish()?)?;
    fs::remove_file(plain)
}
