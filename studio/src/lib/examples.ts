/** The example trains, within the page. */

import type { Doc } from "./types";

const trains = import.meta.glob("../../../examples/*.toml", { query: "?raw", import: "default", eager: true }) as Record<string, string>;
const tables = import.meta.glob("../../../examples/*.csv", { query: "?raw", import: "default", eager: true }) as Record<string, string>;

const stem = (path: string) => path.replace(/^.*\//, "");

/** Files without members are duty cycles and the like. */
const all = Object.entries(trains)
  .filter(([, text]) => /^members\s*=/m.test(text))
  .map(([path, text]) => ({ name: stem(path), title: /^name\s*=\s*"([^"]*)"/m.exec(text)?.[1] ?? stem(path), text }));

const SHELVES: [string, RegExp][] = [
  ["Automatics", /8hp|aisin|simpson|mercedes|w5a|ravigneaux|wilson|gm-|shift|automatic|lepelletier/i],
  ["Power split", /prius|split|cvt|voltec|hybrid|variator|two-mode|hydro/i],
  ["Wind, marine and industry", /wind|fva|turbine|herringbone|marine|stage|wang/i],
];

export interface Example {
  name: string;
  title: string;
}

/** The shelves in order; what fits none is a textbook train. */
export function shelves(): [string, Example[]][] {
  const left = new Set(all);
  const own = SHELVES.map(([shelf, is]): [string, Example[]] => {
    const found = [...left].filter((e) => is.test(e.name));
    found.forEach((e) => left.delete(e));
    return [shelf, found];
  });
  return ([["Textbook", [...left]], ...own] as [string, Example[]][]).filter(([, list]) => list.length > 0);
}

/** An example as a document, with the tables that it names. */
export function example(name: string): Doc | null {
  const found = all.find((e) => e.name === name || e.name === `${name}.toml`);
  if (!found) return null;
  const named = Object.entries(tables).filter(([path]) => found.text.includes(stem(path)));
  return { name: found.name, text: found.text, files: Object.fromEntries(named.map(([path, text]) => [stem(path), text])) };
}

/** Tests of an example, which `calibrate` takes. */
export function testsOf(name: string): { name: string; text: string } | null {
  const called = `tests-${name.replace(/\.toml$/, "")}.csv`;
  const found = Object.entries(tables).find(([path]) => stem(path) === called);
  return found ? { name: called, text: found[1] } : null;
}
