/** A link that holds file, point and view; nothing leaves the page but by the hand of who copies it. */

import { example } from "./examples";
import { version } from "./willis";
import type { Doc, Look, Point } from "./types";

interface Held {
  /** The file, or the name of an example. */
  t: string | Doc;
  p: Point;
  v: Partial<Look>;
  w: string;
}

const PREFIX = "#1.";

async function through(bytes: Uint8Array<ArrayBuffer>, by: GenericTransformStream): Promise<Uint8Array<ArrayBuffer>> {
  return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(by)).arrayBuffer());
}

function coded(bytes: Uint8Array): string {
  let text = "";
  for (let k = 0; k < bytes.length; k += 0x8000) text += String.fromCharCode(...bytes.subarray(k, k + 0x8000));
  return btoa(text).replace(/\+/g, "-").replace(/\//g, "_").replace(/=+$/, "");
}

function decoded(text: string): Uint8Array<ArrayBuffer> {
  return Uint8Array.from(atob(text.replace(/-/g, "+").replace(/_/g, "/")), (c) => c.charCodeAt(0));
}

export async function link(doc: Doc, point: Point, view: Partial<Look>): Promise<string> {
  const known = example(doc.name);
  const t = known && known.text === doc.text ? doc.name : doc;
  const held: Held = { t, p: point, v: view, w: version() };
  const packed = await through(new TextEncoder().encode(JSON.stringify(held)), new CompressionStream("deflate-raw"));
  return PREFIX + coded(packed);
}

const within = (x: unknown, low: number, high: number) => typeof x === "number" && x >= low && x <= high;

/** What a link holds; a sentence where it cannot be read. */
export async function opened(hash: string): Promise<{ doc: Doc; point: Point; view: Partial<Look>; other: string | null } | string | null> {
  if (!hash || hash === "#") return null;
  if (!hash.startsWith(PREFIX)) return "This link is of another version of the studio.";
  try {
    const text = new TextDecoder().decode(await through(decoded(hash.slice(PREFIX.length)), new DecompressionStream("deflate-raw")));
    const held = JSON.parse(text) as Held;
    const doc = typeof held.t === "string" ? example(held.t) : held.t;
    if (!doc || typeof doc.text !== "string") return "The link names an example that is not on the shelf.";
    const p = held.p;
    const point: Point = {
      state: p.state ?? null,
      engaged: p.engaged ?? null,
      speeds: p.speeds ?? {},
      torques: p.torques ?? {},
      powers: p.powers ?? {},
      fixed: p.fixed ?? [],
      more: p.more ?? {},
    };
    const v = held.v ?? {};
    const view: Partial<Look> = {
      answer: Number.isInteger(v.answer) && within(v.answer, 0, 1000) ? v.answer! : 0,
      seen_from: typeof v.seen_from === "string" ? v.seen_from : null,
      losses: within(v.losses, 1, 50) ? v.losses! : null,
    };
    const own = version();
    return { doc: { name: doc.name, text: doc.text, files: doc.files ?? {} }, point, view, other: held.w === own ? null : held.w };
  } catch {
    return "The link is damaged: a part of it is missing.";
  }
}
