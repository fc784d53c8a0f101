/** Questions that take longer than a frame, each in a worker of its own kind; a new one of a kind cancels the one before. */

import { module } from "./module";
import type { Doc, Point, Refusal } from "./types";
import type { Job, Told } from "./worker";
import LongWork from "./worker?worker&inline";

/** After this time a job is ended. */
export const BUDGET_MS = 20_000;
/** After this time without a job a worker is ended: it holds the whole library. */
const IDLE_MS = 60_000;

export class Stopped extends Error {
  /** `overtaken`: a later question took its place. */
  constructor(
    readonly why: "overtaken" | "idle" | "slow" | "broken",
    words: string,
  ) {
    super(words);
  }
}
export class Refused extends Error {
  constructor(readonly refusal: Refusal) {
    super(refusal.diagnostics[0]?.message ?? "refused");
  }
}

interface Lane {
  worker: Worker;
  job: { id: number; settle: (told: Told) => void; fail: (why: Error) => void; timer: number } | null;
  idle: number;
}

const lanes = new Map<string, Lane>();
let jobs = 0;

async function lane(name: string): Promise<Lane> {
  const given = await module();
  const there = lanes.get(name);
  if (there) return there;
  const made: Lane = { worker: new LongWork(), job: null, idle: 0 };
  made.worker.onmessage = (event: MessageEvent<Told>) => {
    if (made.job && event.data.id === made.job.id) made.job.settle(event.data);
  };
  made.worker.onerror = (event) => {
    event.preventDefault();
    end(name, new Stopped("broken", `the computation stopped: ${event.message}`));
  };
  made.worker.postMessage({ module: given });
  lanes.set(name, made);
  return made;
}

function end(name: string, why: Error): void {
  const there = lanes.get(name);
  if (!there) return;
  lanes.delete(name);
  there.worker.terminate();
  clearTimeout(there.idle);
  if (there.job) {
    clearTimeout(there.job.timer);
    there.job.fail(why);
  }
}

/** Cancels what runs in a lane. */
export function cancel(name: string): void {
  if (lanes.get(name)?.job) end(name, new Stopped("overtaken", "a later step took its place"));
}

/** Asks in a lane; `progress` hears the part that is done. The answer is the text that the command line would write. */
export async function ask(
  name: string,
  asked: { doc: Doc; point: Point; question: string; request: unknown; form?: string },
  progress: (what: string, part: number) => void = () => {},
): Promise<string> {
  cancel(name);
  const at = await lane(name);
  if (at.job) end(name, new Stopped("overtaken", "a later step took its place"));
  const now = lanes.get(name) ?? (await lane(name));
  const id = ++jobs;
  return new Promise((resolve, reject) => {
    const timer = window.setTimeout(() => end(name, new Stopped("slow", `stopped after ${BUDGET_MS / 1000} s`)), BUDGET_MS);
    const fail = (why: Error) => reject(why);
    const settle = (told: Told) => {
      if (!told.done) return progress(told.what, told.part);
      clearTimeout(timer);
      now.job = null;
      now.idle = window.setTimeout(() => end(name, new Stopped("idle", "nobody asks")), IDLE_MS);
      if (told.refused) reject(new Refused(told.refused));
      else resolve(told.answer ?? "");
    };
    clearTimeout(now.idle);
    now.job = { id, settle, fail, timer };
    const job: Job = {
      id,
      doc: $state.snapshot(asked.doc) as Doc,
      point: $state.snapshot(asked.point) as Point,
      question: asked.question,
      request: asked.request,
      form: asked.form ?? "json",
    };
    now.worker.postMessage(job);
  });
}

/** The first file of an answer in another form. */
export async function tell(name: string, asked: Parameters<typeof ask>[1], progress?: Parameters<typeof ask>[2]): Promise<string> {
  const files = JSON.parse(await ask(name, asked, progress)) as { name: string; text: string }[];
  return files[0]?.text ?? "";
}
