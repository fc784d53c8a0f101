/** A question that is asked again when what it is about has changed, while it is on the screen. */

import { getContext, onDestroy } from "svelte";
import { Refused, Stopped, ask, cancel, tell } from "./ask.svelte";
import { store } from "./store.svelte";
import type { Doc, Point, Refusal } from "./types";

export interface Asking {
  question: string;
  request: Record<string, unknown>;
  form?: string;
  /** Else what the store shows. */
  point?: Point;
}

/** Panes side by side have workers of their own. */
export const SIDE = "side";

export class Answer {
  text = $state.raw<string | null>(null);
  /** What the text answers, which may be what was asked before. */
  of = $state.raw<Asking | null>(null);
  refusal = $state.raw<Refusal | null>(null);
  /** Why there is no answer, where that is not the train's fault. */
  stopped = $state("");
  busy = $state(false);
  part = $state(0);
  what = $state("");

  #lane: string;
  #asked = $state.raw("");
  #turn = 0;

  /** `asking` is read in an effect: null where nothing is to be asked now. */
  constructor(lane: string, asking: () => Asking | null, wait = 250) {
    this.#lane = `${getContext<string | undefined>(SIDE) ?? ""} ${lane}`;
    $effect(() => {
      const asked = asking();
      if (!asked || store.broken) return;
      const doc = store.doc;
      const given = { ...asked, doc, point: asked.point ?? store.point };
      const key = JSON.stringify([doc.name, doc.text, given.point, asked.question, asked.request, asked.form]);
      if (key === this.#asked) return;
      // What changes on and on, as in a drag, is asked when it rests.
      const timer = setTimeout(() => void this.#run(key, given), this.text === null ? 0 : wait);
      return () => clearTimeout(timer);
    });
    onDestroy(() => {
      this.#turn++;
      cancel(this.#lane);
    });
  }

  /** Once more, after it was stopped. */
  again(): void {
    this.#asked = "";
  }

  async #run(key: string, given: Asking & { doc: Doc; point: Point }): Promise<void> {
    const turn = ++this.#turn;
    this.#asked = key;
    this.busy = true;
    this.part = 0;
    this.what = "";
    this.stopped = "";
    const progress = (what: string, part: number) => {
      if (turn !== this.#turn) return;
      this.what = what;
      this.part = Math.min(1, part);
    };
    try {
      const form = given.form ?? "json";
      const text = await (form === "json" ? ask : tell)(this.#lane, { ...given, form }, progress);
      if (turn !== this.#turn) return;
      this.text = text;
      this.of = given;
      this.refusal = null;
    } catch (why) {
      if (turn !== this.#turn) return;
      if (why instanceof Refused) this.refusal = why.refusal;
      else if (why instanceof Stopped && why.why === "overtaken") this.#asked = "";
      else this.stopped = why instanceof Error ? why.message : String(why);
    }
    this.busy = false;
  }
}

/** The operation that is shown, or its state, as the library calls them. */
export function here(): Record<string, unknown> {
  const { operation, state } = store.view ?? {};
  return operation ? { operation } : state ? { state } : {};
}

/** The state that is shown, for questions that do not look at an operation. */
export function inState(): Record<string, unknown> {
  const state = store.view?.state;
  return state ? { state } : {};
}
