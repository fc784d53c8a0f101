/** The library as WebAssembly, on the page and in its workers. */

import init, { Session, newTrain, version } from "../wasm/willis_web.js";
import type { Refusal } from "./types";

export { Session, newTrain, version };

declare global {
  // What the library calls while it works on something long.
  var willisProgress: (what: string, steps: number, begins: boolean) => void;
}

/** Starts the library from its compiled module. */
export async function loadWith(given: WebAssembly.Module): Promise<void> {
  globalThis.willisProgress ??= () => {};
  await init({ module_or_path: given });
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
