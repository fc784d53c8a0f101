/** Numbers of teeth: which there are, what follows from them, and how they are changed. */

import type { Session } from "./willis";
import { store } from "./store.svelte";
import type { Refusal } from "./types";

export interface Wheel {
  set: string;
  /** The path of its number of teeth. */
  path: string;
  /** `sun`, `ring` or, where a set has several, `rings 1`. */
  part: string;
  member: string;
  teeth: number;
}

const given = (path: string) => store.facts?.quantities.find((q) => q.path === path)?.value ?? null;

/** All wheels on members, in the order of the file. */
export function wheels(): Wheel[] {
  const all: Wheel[] = [];
  for (const set of store.facts?.sets ?? []) {
    const own = `${set.name}.`;
    for (const q of store.facts?.quantities ?? []) {
      if (!q.path.startsWith(own) || !q.path.endsWith(".member") || q.value === null) continue;
      const stem = q.path.slice(0, -".member".length);
      const teeth = Number(given(`${stem}.teeth`) ?? NaN);
      const part = stem.slice(own.length).replace(/\.(\d+)$/, (_, k) => ` ${Number(k) + 1}`).replaceAll(".", " ");
      if (Number.isInteger(teeth)) all.push({ set: set.name, path: `${stem}.teeth`, part, member: q.value, teeth });
    }
  }
  return all;
}

/** Planets of a simple set that the file gives, and with them the wheels on both sides. */
function chain(set: string): { sun: number; planet: number; ring: number } | null {
  const of = store.facts?.sets.find((s) => s.name === set);
  if ((of?.type ?? "simple") !== "simple") return null;
  const [sun, planet, ring] = ["sun", "planet", "ring"].map((part) => Number(given(`${set}.${part}.teeth`) ?? NaN));
  return [sun, planet, ring].every(Number.isInteger) ? { sun: sun!, planet: planet!, ring: ring! } : null;
}

/** The edit that gives a wheel so many teeth; planets that the file counts follow, as far as they can. */
export function count(wheel: Wheel, teeth: number): (session: Session) => string {
  const all = chain(wheel.set);
  const part = wheel.part as "sun" | "ring";
  if (!all || !(part in all)) return (s) => s.set(wheel.path, String(teeth));
  const next = { ...all, [part]: teeth };
  // What the planets were short of, as with a shifted profile, they stay short of.
  const planet = all.planet + (next.ring - all.ring - (next.sun - all.sun)) / 2;
  const [paths, values] = [[wheel.path], [String(teeth)]];
  if (Number.isInteger(planet) && planet !== all.planet) {
    paths.push(`${wheel.set}.planet.teeth`);
    values.push(String(planet));
  }
  return (s) => s.setAll(paths, values);
}

/** Why a wheel cannot have so many teeth. */
export function rule(wheel: Wheel, teeth: number): Refusal | null {
  return store.check(count(wheel, teeth));
}

/** The next possible number of teeth from one on, in a direction; that one itself where none is near. */
export function possible(wheel: Wheel, teeth: number, way: number): number {
  for (let k = 0; k < 24; k++) if (teeth + way * k > 0 && !rule(wheel, teeth + way * k)) return teeth + way * k;
  return teeth;
}

function reduced(a: number, b: number): string {
  let [x, y] = [a, b];
  while (y) [x, y] = [y, x % y];
  return b === x ? `${a / x}` : `${a / x}/${b / x}`;
}

/** The basic ratio of a set exactly, with the carrier at rest, perhaps with another number of teeth; empty where it has none. */
export function basic(set: string, with_?: Wheel, teeth?: number): string {
  const of = store.facts?.sets.find((s) => s.name === set);
  const sign = { simple: "\u2212", "double-planet": "" }[(of?.type ?? "simple") as string];
  const own = (part: string) => (with_?.part === part && teeth ? teeth : Number(of?.[part]?.teeth ?? NaN));
  const [sun, ring] = [own("sun"), own("ring")];
  return sign === undefined || !Number.isInteger(sun) || !Number.isInteger(ring) ? "" : sign + reduced(ring, sun);
}
