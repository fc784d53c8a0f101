//! Writes the JavaScript and the types for `willis_web.wasm`: `willis-bindgen FILE.wasm FOLDER`.
//!
//! No address of the WebAssembly is written into the script: the page says where it is, so that it can be within the page.

use std::process::ExitCode;

use wasm_bindgen_cli_support::Bindgen;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [input, folder] = words.as_slice() else {
        eprintln!("usage: willis-bindgen FILE.wasm FOLDER");
        return ExitCode::FAILURE;
    };
    let written = Bindgen::new()
        .input_path(input)
        .web(true)
        .and_then(|b| b.omit_default_module_path(true).typescript(true).remove_name_section(true).generate(folder));
    match written {
        Ok(()) => ExitCode::SUCCESS,
        Err(wrong) => {
            eprintln!("{wrong:#}");
            ExitCode::FAILURE
        }
    }
}
