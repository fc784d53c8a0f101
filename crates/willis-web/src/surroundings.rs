//! What long work has around it in a browser: one thread, and somebody who is told how far it is. Who wants to stop it ends the
//! worker in which it runs.

use wasm_bindgen::prelude::wasm_bindgen;
use willis::work::Work;

#[wasm_bindgen]
extern "C" {
    /// The page defines it, in every worker too.
    #[cfg(target_arch = "wasm32")]
    #[wasm_bindgen(js_namespace = globalThis, js_name = willisProgress)]
    fn progress(what: &str, steps: f64, begins: bool);

    /// Milliseconds since the page or its worker began.
    #[cfg(target_arch = "wasm32")]
    #[wasm_bindgen(js_namespace = performance)]
    fn now() -> f64;
}

/// Nobody listens outside a browser.
#[cfg(not(target_arch = "wasm32"))]
fn progress(_: &str, _: f64, _: bool) {}

/// Work in a browser.
pub struct Browser;

impl Work for Browser {
    fn begin(&self, what: &'static str, of: u64) {
        progress(what, of as f64, true);
    }

    fn advance(&self, steps: u64) {
        progress("", steps as f64, false);
    }

    #[cfg(target_arch = "wasm32")]
    fn clock(&self) -> Option<f64> {
        Some(now() / 1e3)
    }

    fn patience(&self) -> f64 {
        20.0
    }
}
