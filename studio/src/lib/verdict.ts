/** What the library says of a point, in a word and a sentence, and how good that is. */

import { store } from "./store.svelte";

export interface Verdict {
  word: string;
  told: string;
  kind: "good" | "warn" | "bad";
}

export function verdict(): Verdict {
  const op = store.operation;
  if (store.broken) return { word: "The file has an error.", told: "The last good train is shown.", kind: "bad" };
  if (store.view?.refused) return { word: "No answer.", told: store.view.refused.diagnostics[0]?.message ?? "", kind: "bad" };
  if (!op) {
    const ratio = Object.values(store.view?.analysis?.ratios ?? {})[0];
    return { word: "No operating point.", told: ratio?.no_ratio ?? "Give a speed and a torque.", kind: "warn" };
  }
  const proof = op.certificate?.unique_for_every_load ? "proved for any load in these directions" : "found by trying every case";
  switch (op.verdict) {
    case "unique":
      return { word: "Moves.", told: `One equilibrium, ${proof}.`, kind: "good" };
    case "multiple":
      return { word: `${op.solutions.length} answers.`, told: op.reason ?? "Friction decides between them.", kind: "warn" };
    case "locked":
      return { word: "Locked.", told: op.reason ?? "No equilibrium drives the load.", kind: "bad" };
    case "unloaded":
      return { word: "Unloaded.", told: op.reason ?? "No power passes.", kind: "warn" };
    default:
      return { word: "Undetermined.", told: op.reason ?? "Something is missing.", kind: "warn" };
  }
}
