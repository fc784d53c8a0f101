//! Unpacks LZMA in a browser, which has no such stream of its own: the library of the studio is a third smaller so.

use std::io::Read;

use lzma_rust2::LzmaReader;
use wasm_bindgen::prelude::wasm_bindgen;

/// What is packed in an `.lzma` file; empty where it is damaged.
#[wasm_bindgen]
pub fn unpack(packed: &[u8]) -> Vec<u8> {
    let mut plain = Vec::new();
    let read = LzmaReader::new_mem_limit(packed, u32::MAX, None).and_then(|mut r| r.read_to_end(&mut plain));
    if read.is_err() {
        plain.clear();
    }
    plain
}
