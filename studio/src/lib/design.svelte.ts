/** What a train must do, and every train that does it: the wish stays while tabs and trains change. */

import { Refused, Stopped, ask, cancel } from "./ask.svelte";
import { plain } from "./numbers";
import { NOTHING, store } from "./store.svelte";
import type { Doc, Refusal } from "./types";
import { newTrain } from "./willis";

export interface Row {
  number: number;
  sets: Record<string, { teeth: Record<string, number>; planets: number[]; chosen: number; hunting: boolean; phase: string }>;
  error: number;
  ring_diameter_m: number | null;
  ring_teeth: number;
  forward: number | null;
  backward: number | null;
  self_locking: boolean;
  lock_margin: number | null;
  planet_spin: number;
  member_speed: number;
  element_torque: number | null;
  /** Efficiencies under the laws of friction of the file, in its operations. */
  laws?: { forward: number | null; backward: number | null; self_locking: boolean };
}

export interface Found {
  name: string;
  wish: string;
  completeness: { complete: boolean; statement: string };
  space: { candidates: number };
  waterfall: { condition: string; trains: number; designs: number }[];
  objectives: string[];
  ranked_by: { by: "mesh_efficiencies" | "laws"; forward: string[]; backward: string[]; words: string };
  front: number;
  rows: Row[];
  own?: { name: string; fails: string[]; better: number; row: Row };
  relaxations: { wish: string; now: number | null; needed: number | null; trains: number; words: string }[];
  diagnostics: { message: string }[];
}

export type Start = "around" | "kind" | "file";

/** Kinds of drives, with the ratios that they reach. */
export const KINDS: Record<string, { title: string; least: number; most: number }> = {
  simple: { title: "simple set", least: 2.5, most: 12 },
  "two-stage": { title: "two stages", least: 8, most: 120 },
  "3k": { title: "3K drive", least: 10, most: 500 },
  stepped: { title: "stepped planets", least: 4, most: 25 },
  "two-rings": { title: "two rings", least: 10, most: 500 },
  ravigneaux: { title: "Ravigneaux set", least: 1.2, most: 4 },
};

/** A wish that may be left out. */
export interface Bound {
  on: boolean;
  value: number;
}

/** Rows of a wish: as many points as can be told apart. */
const MOST_ROWS = 100;
/** A search that takes longer is stopped by the next move; a shorter one is waited for, because a worker takes as long to begin. */
const PATIENCE_MS = 700;

/** What is remembered of a wish: whole, so that equal wishes are one text. */
type Request = Record<string, unknown>;

class Design {
  start = $state<Start>("kind");
  kind = $state("3k");
  ratio = $state(100);
  /** Relative, of the ratio. */
  tolerance = $state(0.01);
  /** Largest ring, mm. */
  ring = $state<Bound>({ on: true, value: 90 });
  forward = $state<Bound>({ on: false, value: 0.8 });
  backward = $state<Bound>({ on: true, value: 0.6 });
  /** The text of a design file. */
  text = $state("");
  /** The train around which others are searched. */
  base = $state.raw<Doc | null>(null);

  found = $state.raw<Found | null>(null);
  refusal = $state.raw<Refusal | null>(null);
  stopped = $state("");
  busy = $state(false);
  part = $state(0);
  /** How long the last search took, ms, with the way to the worker. */
  took = $state(0);
  /** What was found answers this wish. */
  of = $state.raw("");
  /** The row that is shown as the train of the page. */
  shown = $state<number | null>(null);
  /** The row whose train is being made. */
  opening = $state<number | null>(null);

  #wanted: { key: string; request: Request } | null = null;
  #running = false;
  #began = 0;

  request(): Request | null {
    const told = (n: number) => plain(Number(n.toPrecision(6)));
    const wishes: Request = { tolerance: told(this.tolerance) };
    if (this.ring.on) wishes.ring = `${told(this.ring.value)} mm`;
    if (this.forward.on) wishes.forward = told(this.forward.value);
    if (this.backward.on) wishes.backward = told(this.backward.value);
    const like = this.base ? { name: this.base.name, text: this.base.text } : null;
    switch (this.start) {
      case "kind":
        return { kind: this.kind, ratio: told(this.ratio), ...wishes };
      case "around":
        return like && { like, ...wishes };
      case "file":
        return this.text.trim() ? { file: { name: "design.toml", text: this.text } } : null;
    }
  }

  /** Searches for a wish as soon as may be; wishes in between are left out. */
  want(request: Request): void {
    const key = JSON.stringify(request);
    if (key === this.of || key === this.#wanted?.key) return;
    this.#wanted = { key, request };
    if (!this.#running) void this.#run();
    else if (performance.now() - this.#began > PATIENCE_MS) cancel("design");
    else setTimeout(() => this.#wanted?.key === key && this.#running && cancel("design"), PATIENCE_MS);
  }

  /** Once more, after it was stopped. */
  again(): void {
    this.of = "";
  }

  async #run(): Promise<void> {
    this.#running = true;
    this.busy = true;
    while (this.#wanted) {
      const { key, request } = this.#wanted;
      this.#began = performance.now();
      this.part = 0;
      try {
        const asked = { doc: this.#doc, point: NOTHING, question: "design", request: { ...request, top: MOST_ROWS } };
        const text = await ask("design", asked, (_, part) => (this.part = Math.min(1, part)));
        this.found = JSON.parse(text) as Found;
        this.refusal = null;
        this.stopped = "";
        this.took = performance.now() - this.#began;
        this.shown = null;
        this.opening = null;
      } catch (why) {
        if (why instanceof Refused) this.refusal = why.refusal;
        else if (!(why instanceof Stopped && why.why === "overtaken")) this.stopped = why instanceof Error ? why.message : String(why);
      }
      if (this.#wanted?.key === key) {
        this.#wanted = null;
        this.of = key;
      }
    }
    this.busy = false;
    this.#running = false;
  }

  /** The file that workers read beside a design: any that is a train, and always the same. */
  get #doc(): Doc {
    return this.base ?? { name: "train.toml", text: newTrain("set"), files: {} };
  }

  async #told(form: string, more: Request): Promise<string | null> {
    const request = this.request();
    if (!request) return null;
    try {
      const asked = { doc: this.#doc, point: NOTHING, question: "design", request: { ...request, ...more }, form };
      return (JSON.parse(await ask("design row", asked)) as { text: string }[])[0]?.text ?? null;
    } catch (why) {
      if (why instanceof Refused) this.refusal = why.refusal;
      return null;
    }
  }

  /** Opens a row as the train of the page; all panels show it. */
  async open(row: Row): Promise<void> {
    this.opening = row.number;
    // By its teeth: nothing is searched once more.
    const text = await this.#told("train", { teeth: Object.values(row.sets).map((s) => Object.values(s.teeth).join("/")) });
    // Another row, or another wish, may have come before it.
    if (this.opening !== row.number) return;
    this.opening = null;
    if (text === null) return;
    this.shown = row.number;
    store.open({ name: `design-${row.number}.toml`, text, files: this.base?.files ?? {} });
    store.say(`row ${row.number} is the train of the page; undo brings back the one before`);
  }

  /** The wish as a design file, to be written on by hand. */
  async asFile(): Promise<void> {
    const text = await this.#told("design-file", {});
    if (text === null) return;
    this.text = text;
    this.start = "file";
  }

  around(doc: Doc): void {
    this.base = doc;
    this.start = "around";
    this.ring = { ...this.ring, on: false };
    this.forward = { ...this.forward, on: false };
    this.backward = { ...this.backward, on: false };
  }
}

export const design = new Design();
