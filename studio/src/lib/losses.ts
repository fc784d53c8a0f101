// Where the power of an answer is lost.

import type { Solution } from "./types";

export interface Loss {
  name: string;
  law: string;
  /** W */
  loss: number;
}

/** Every loss by its source, the largest first; where efficiencies are given, of each mesh and variator its own. */
export function losses(solution: Solution | null | undefined): Loss[] {
  if (!solution) return [];
  const given = { ...solution.meshes, ...solution.variators };
  const all: Loss[] = solution.sources?.length
    ? solution.sources.map((x) => ({ name: x.name, law: x.law ?? x.kind ?? "", loss: x.loss_w }))
    : Object.entries(given).map(([name, own]) => ({ name, law: "given efficiency", loss: own.loss_w }));
  return all.filter((x) => x.loss > 0).sort((a, b) => b.loss - a.loss);
}
