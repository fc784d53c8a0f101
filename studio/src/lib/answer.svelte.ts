/** A question that is asked again when what it is about has changed, while it is on the screen. */

import { getContext, onDestroy } from "svelte";
import { Refused, Stopped, ask, cancel } from "./ask.svelte";
import { store } from "./store.svelte";
import type { Doc, Point, Refusal } from "./types";

export interface Asking {
  question: string;
  request: Record<string, unknown>;
  form?: string;
  /** Else what the store shows. */
  point?: Point;
  /** First a coarse answer, which is there at once, then the fine one. */
  coarse?: boolean;
}

/** Panes side by side have workers of their own. */
export const SIDE = "side";

export class Answer {
  text = $state.raw<string | null>(null);
  /** The second file of an answer that has two, such as the data of a picture. */
  data = $state.raw<string | null>(null);
  /** What is shown is the coarse answer. */
  rough = $state(false);
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
      const timer = setTimeout(() => void this.#run(key, given), this.text === null || asked.coarse ? 0 : wait);
      return () => clearTimeout(timer);
    });
    onDestroy(() => {
      this.#turn++;
      cancel(this.#lane);
      cancel(this.#first);
    });
  }

  /** The lane of coarse answers: they are short, and its worker lives on while that of the fine ones is ended. */
  get #first(): string {
    return `${this.#lane} first`;
  }

  /** Once more, after it was stopped. */
  again(): void {
    this.#asked = "";
  }

  async #run(key: string, given: Asking & { doc: Doc; point: Point }): Promise<void> {
    const turn = ++this.#turn;
    this.#asked = key;
    this.busy = true;
    this.rough = false;
    this.part = 0;
    this.what = "";
    this.stopped = "";
    const progress = (what: string, part: number) => {
      if (turn !== this.#turn) return;
      this.what = what;
      this.part = Math.min(1, part);
    };
    try {
      if (given.coarse) {
        cancel(this.#lane);
        await this.#take(this.#first, turn, { ...given, request: { ...given.request, coarse: true } }, given, progress);
        if (turn !== this.#turn) return;
        this.rough = true;
      }
      await this.#take(this.#lane, turn, given, given, progress);
      if (turn !== this.#turn) return;
      this.rough = false;
    } catch (why) {
      if (turn !== this.#turn) return;
      if (why instanceof Refused) this.refusal = why.refusal;
      else if (why instanceof Stopped && why.why === "overtaken") this.#asked = "";
      else this.stopped = why instanceof Error ? why.message : String(why);
    }
    this.busy = false;
  }

  async #take(lane: string, turn: number, asked: Asking & { doc: Doc; point: Point }, of: Asking, progress: (what: string, part: number) => void): Promise<void> {
    const form = asked.form ?? "json";
    const told = await ask(lane, { doc: asked.doc, point: asked.point, question: asked.question, request: asked.request, form }, progress);
    if (turn !== this.#turn) return;
    const files = form === "json" ? [{ text: told }] : (JSON.parse(told) as { text: string }[]);
    this.data = files[1]?.text ?? null;
    this.of = of;
    this.text = files[0]?.text ?? "";
    this.refusal = null;
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
