/** The library as WebAssembly: loaded once, here and in every worker. */

import init, { Session, initSync, newTrain, questions, version } from "../wasm/willis_web.js";
import packed from "../wasm/willis_web_bg.wasm.gz?inline";
import type { Refusal } from "./types";

export { Session, newTrain, questions, version };

declare global {
  // What the library calls while it works on something long.
  var willisProgress: (what: string, steps: number, begins: boolean) => void;
}

let compiled: Promise<WebAssembly.Module> | null = null;

/** The module, unpacked from the page: no request is made for it. */
export function module(): Promise<WebAssembly.Module> {
  compiled ??= (async () => {
    const text = atob(packed.slice(packed.indexOf(",") + 1));
    const bytes = Uint8Array.from(text, (c) => c.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
    return WebAssembly.compile(await new Response(stream).arrayBuffer());
  })();
  return compiled;
}

export async function load(): Promise<void> {
  globalThis.willisProgress ??= () => {};
  await init({ module_or_path: await module() });
}

/** In a worker, which is given the module. */
export function loadWith(given: WebAssembly.Module): void {
  globalThis.willisProgress ??= () => {};
  initSync({ module: given });
}

/** A refusal of the library, thrown as JSON; anything else is a fault of ours. */
export function refusal(thrown: unknown): Refusal {
  const text = typeof thrown === "string" ? thrown : String(thrown);
  try {
    const read = JSON.parse(text) as Refusal;
    if (read.format === "willis-refusal-1") return read;
  } catch {
    // Below.
  }
  const message = `the library stopped: ${text}`;
  return {
    format: "willis-refusal-1",
    file: null,
    diagnostics: [{ code: "", severity: "error", place: "", message, hints: ["undo the last step, or load the page again"] }],
  };
}

/** Whether an answer is a refusal. */
export function refused(text: string): Refusal | null {
  return text.startsWith("{") && text.slice(0, 60).includes('"willis-refusal-1"') ? (JSON.parse(text) as Refusal) : null;
}
