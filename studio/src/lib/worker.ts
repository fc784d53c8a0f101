/** A worker for what takes longer than a frame. One job at a time; who wants another one ends the worker. */

import { Session, loadWith, refusal } from "./willis";
import type { Doc, Point } from "./types";

export interface Job {
  id: number;
  doc: Doc;
  point: Point;
  question: string;
  request: unknown;
  /** `json`, `text`, `csv`, `svg` or another form of the question. */
  form: string;
}

export type Told =
  | { id: number; done: true; answer?: string; refused?: ReturnType<typeof refusal> }
  | { id: number; done: false; what: string; part: number };

let session: { doc: Doc; it: Session } | null = null;
let job = 0;
let stage = { what: "", of: 0, steps: 0, told: 0 };

function same(a: Doc, b: Doc): boolean {
  return a.name === b.name && a.text === b.text && JSON.stringify(a.files) === JSON.stringify(b.files);
}

let loaded: Promise<void> = Promise.resolve();

onmessage = async (event: MessageEvent<{ module: WebAssembly.Module } | Job>) => {
  if ("module" in event.data) {
    loaded = loadWith(event.data.module);
    return;
  }
  await loaded;
  const { id, doc, point, question, request, form } = event.data;
  job = id;
  globalThis.willisProgress = (what, steps, begins) => {
    stage = begins ? { what, of: steps, steps: 0, told: 0 } : { ...stage, steps: stage.steps + steps };
    const now = performance.now();
    if (begins || now - stage.told > 60) {
      stage.told = now;
      postMessage({ id: job, done: false, what: stage.what, part: stage.of > 0 ? stage.steps / stage.of : 0 } satisfies Told);
    }
  };
  try {
    if (!session || !same(session.doc, doc)) {
      session?.it.free();
      session = null;
      session = { doc, it: new Session(doc.name, doc.text, JSON.stringify(doc.files)) };
    }
    const asked = JSON.stringify(request);
    const at = JSON.stringify(point);
    const answer = form === "json" ? session.it.ask(question, asked, at) : session.it.tell(question, asked, form, at);
    postMessage({ id, done: true, answer } satisfies Told);
  } catch (thrown) {
    postMessage({ id, done: true, refused: refusal(thrown) } satisfies Told);
  }
};
