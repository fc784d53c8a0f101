/**
 * One state for all panels: the text of the file, the point, and what the library says of both. Every change is a step that can
 * be taken back; a drag is one step.
 */

import { RPM, figures, plain, rounded } from "./numbers";
import { Session, refusal, refused } from "./willis";
import type { Analysis, Boxes, Doc, Facts, Frame, OperationReport, Point, Refusal, Solution } from "./types";

export interface Step {
  doc: Doc;
  point: Point;
  what: string;
}

export interface View {
  analysis: Analysis | null;
  /** What is wrong with this point. */
  refused: Refusal | null;
  operation: string | null;
  state: string | null;
  stick: string;
  lever: string;
  power: string;
  frame: Frame | null;
  /** Counts frames: all panels of one frame carry the same. */
  generation: number;
  /** Time for all of it, ms. */
  took: number;
}

const MOST_STEPS = 200;
/** What a point says of an operation in fields of its own. */
const OWN_KEYS = ["name", "state", "speeds", "torques", "powers", "fixed"];
/** As the command line. */
const MOST_TEXT = 4 * 2 ** 20;
export const NOTHING: Point = { state: null, engaged: null, speeds: {}, torques: {}, powers: {}, fixed: [], more: {} };

class Store {
  doc = $state.raw<Doc>({ name: "", text: "", files: {} });
  point = $state.raw<Point>(NOTHING);
  facts = $state.raw<Facts | null>(null);
  /** What is wrong with the text; panels keep the last good train. */
  broken = $state.raw<Refusal | null>(null);
  view = $state.raw<View | null>(null);
  boxes = $state.raw<Boxes>({ width: 700, stick: 300, lever: 260, power: [640, 280], scale: null });
  hovered = $state<string | null>(null);
  /** Something is dragged: scales stay. */
  dragging = $state(false);
  pinned = $state.raw<{ step: Step; view: View } | null>(null);
  labels = $state<"speed" | "torque">("speed");
  /** What the live region says. */
  spoken = $state("");

  #session: Session | null = null;
  #past = $state.raw<Step[]>([]);
  #future = $state.raw<Step[]>([]);
  #before: Step | null = null;
  #typed = 0;
  #generation = 0;
  #frame = 0;

  canUndo = $derived(this.#past.length > 0);
  canRedo = $derived(this.#future.length > 0);

  get operation(): OperationReport | null {
    return this.view?.analysis?.operations[0] ?? null;
  }

  get solution(): Solution | null {
    return this.operation?.solutions[0] ?? null;
  }

  get input(): string | null {
    return this.#ends()[0];
  }

  get output(): string | null {
    return this.#ends()[1];
  }

  get engaged(): string[] {
    if (this.point.engaged) return this.point.engaged;
    return this.facts?.states.find((s) => s.name === this.point.state)?.engaged ?? [];
  }

  #ends(): [string | null, string | null] {
    const own = this.facts?.states.find((s) => s.name === this.point.state)?.ends;
    return own ?? this.facts?.ends ?? [null, null];
  }

  /** Colour number of a member. */
  colour(member: string): number {
    return this.facts?.members.indexOf(member) ?? -1;
  }

  #step(what: string): Step {
    return { doc: this.doc, point: this.point, what };
  }

  #remember(step: Step): void {
    this.#past = [...this.#past.slice(1 - MOST_STEPS), step];
    this.#future = [];
  }

  /** Opens a file; the first operation of it, or its first gear, is shown. */
  open(doc: Doc, point?: Point): boolean {
    if (this.facts) this.#remember(this.#step("open"));
    this.pinned = null;
    const good = this.#read(doc);
    this.point = point ?? (this.facts ? this.#first(this.facts) : NOTHING);
    this.refresh();
    return good;
  }

  #read(doc: Doc): boolean {
    this.doc = doc;
    if (doc.text.length > MOST_TEXT) {
      const message = `the file has ${figures(doc.text.length / 2 ** 20, 3)} MiB, more than 4 MiB`;
      const diagnostic = { code: "", severity: "error" as const, place: "", message, hints: ["a train file is a few kB: leave out what is no train"] };
      this.broken = { format: "willis-refusal-1", file: doc.name, diagnostics: [diagnostic] };
      return false;
    }
    try {
      const session = new Session(doc.name, doc.text, JSON.stringify(doc.files));
      this.#session?.free();
      this.#session = session;
      this.facts = JSON.parse(session.facts()) as Facts;
      this.broken = null;
      return true;
    } catch (thrown) {
      this.broken = refusal(thrown);
      return false;
    }
  }

  #first(facts: Facts): Point {
    const operation = facts.operations[0];
    if (operation) return this.ofOperation(operation);
    return this.inState(facts.states[0]?.name ?? null, facts, NOTHING);
  }

  /** The point of an operation of the file. */
  ofOperation(operation: Record<string, any>): Point {
    const table = (t: unknown): Record<string, string> =>
      Object.fromEntries(Array.isArray(t) ? (t as [string, string][]) : Object.entries((t ?? {}) as Record<string, string>));
    return {
      state: operation.state ?? null,
      engaged: null,
      speeds: table(operation.speeds),
      torques: table(operation.torques),
      powers: table(operation.powers),
      fixed: operation.fixed ?? [],
      more: Object.fromEntries(Object.entries(operation).filter(([key, value]) => !OWN_KEYS.includes(key) && value !== null)),
    };
  }

  /** The point in another gear: speed and load of the input stay. */
  inState(name: string | null, facts: Facts, from: Point): Point {
    const state = facts.states.find((s) => s.name === name);
    const [input] = state?.ends ?? facts.ends;
    if (!input) return { ...NOTHING, state: name };
    const before = this.view?.analysis?.operations[0];
    const speed = from.speeds[input] ?? this.#told(before?.speeds_rad_s[input], RPM, "rpm") ?? "1000 rpm";
    const load: Partial<Point> = from.powers[input]
      ? { powers: { [input]: from.powers[input] } }
      : { torques: { [input]: from.torques[input] ?? this.#told(before?.solutions[0]?.members[input]?.torque_n_m, 1, "N m") ?? "100 N m" } };
    return { ...NOTHING, state: name, speeds: { [input]: speed }, ...load };
  }

  #told(x: number | null | undefined, factor: number, unit: string): string | null {
    return x ? `${plain(Number((x * factor).toPrecision(6)))} ${unit}` : null;
  }

  /** Changes the point; `merge` while something is dragged. */
  move(point: Point, what: string): void {
    if (!this.dragging) this.#remember(this.#step(what));
    this.point = point;
    this.later();
  }

  /** A drag begins. */
  grab(what: string): void {
    this.#before = this.#step(what);
    this.dragging = true;
    this.boxes = { ...this.boxes, scale: this.view?.frame?.scale ?? null };
  }

  /** It ends; taken back, everything is as before. */
  drop(back = false): void {
    const before = this.#before;
    this.#before = null;
    this.dragging = false;
    this.boxes = { ...this.boxes, scale: null };
    if (!before) return;
    if (back) {
      const changed = before.doc !== this.doc;
      this.point = before.point;
      if (changed) this.#read(before.doc);
    } else if (before.doc !== this.doc || before.point !== this.point) this.#remember(before);
    this.refresh();
  }

  /** Another text, typed: steps of one second are one. */
  type(text: string): void {
    const now = performance.now();
    if (now - this.#typed > 1000) this.#remember(this.#step("text"));
    this.#typed = now;
    if (this.#read({ ...this.doc, text })) this.#fit();
    this.refresh();
  }

  /** The file was changed on disk: a step like any other. */
  reread(doc: Doc): void {
    this.#remember(this.#step("changed on disk"));
    if (this.#read({ name: doc.name, text: doc.text, files: doc.files })) this.#fit();
    this.refresh();
  }

  /** An edit of the file by the library; it throws a refusal where the train cannot be so. */
  edit(what: string, change: (session: Session) => string): Refusal | null {
    const session = this.#session;
    if (!session || this.broken) return this.broken;
    let text: string;
    try {
      text = change(session);
    } catch (thrown) {
      return refusal(thrown);
    }
    if (!this.dragging) this.#remember(this.#step(what));
    this.#read({ ...this.doc, text });
    this.#fit();
    if (this.dragging) this.later();
    else this.refresh();
    return null;
  }

  /** The point as far as the train still has what it names. */
  #fit(): void {
    const facts = this.facts;
    if (!facts) return;
    const p = this.point;
    const known = (t: Record<string, string>) => Object.fromEntries(Object.entries(t).filter(([m]) => facts.members.includes(m)));
    const state = facts.states.some((s) => s.name === p.state) ? p.state : null;
    const engaged = p.engaged?.filter((e) => facts.elements.some((x) => x.name === e)) ?? null;
    const fixed = p.fixed.filter((m) => facts.members.includes(m));
    this.point = { state, engaged, speeds: known(p.speeds), torques: known(p.torques), powers: known(p.powers), fixed, more: p.more };
    if (Object.keys(this.point.speeds).length === 0 && !engaged) {
      this.point = this.inState(state ?? facts.states[0]?.name ?? null, facts, this.point);
    }
  }

  undo(): void {
    const step = this.#past.at(-1);
    if (!step) return;
    this.#past = this.#past.slice(0, -1);
    this.#future = [...this.#future, this.#step("undo")];
    this.#take(step);
  }

  redo(): void {
    const step = this.#future.at(-1);
    if (!step) return;
    this.#future = this.#future.slice(0, -1);
    this.#past = [...this.#past, this.#step("redo")];
    this.#take(step);
  }

  #take(step: Step): void {
    if (step.doc !== this.doc) this.#read(step.doc);
    this.point = step.point;
    this.refresh();
  }

  /** Shows with the next frame; moves in between are one. */
  later(): void {
    if (this.#frame) return;
    this.#frame = requestAnimationFrame(() => {
      this.#frame = 0;
      this.refresh();
    });
  }

  resize(boxes: Partial<Boxes>): void {
    const next = { ...this.boxes, ...boxes };
    if (JSON.stringify(next) === JSON.stringify(this.boxes)) return;
    this.boxes = next;
    this.later();
  }

  /** Asks the library for all panels. */
  refresh(): void {
    const session = this.#session;
    if (!session || this.broken) return;
    const began = performance.now();
    try {
      const shown = session.show(JSON.stringify(this.point), JSON.stringify(this.boxes));
      const wrong = refused(shown.analysis);
      this.view = {
        analysis: wrong ? null : (JSON.parse(shown.analysis) as Analysis),
        refused: wrong,
        operation: shown.operation ?? null,
        state: shown.state ?? null,
        stick: shown.stick || (this.view?.stick ?? ""),
        lever: wrong ? (this.view?.lever ?? "") : shown.lever,
        power: wrong ? (this.view?.power ?? "") : shown.power,
        frame: wrong ? (this.view?.frame ?? null) : (JSON.parse(shown.frame) as Frame),
        generation: ++this.#generation,
        took: performance.now() - began,
      };
      shown.free();
    } catch (thrown) {
      this.broken = refusal(thrown);
    }
  }

  /** The text for which the command line gives the same answer. */
  exported(): string {
    return this.#session?.text(JSON.stringify(this.point)) ?? this.doc.text;
  }

  pin(): void {
    this.pinned = this.pinned || !this.view ? null : { step: this.#step("pin"), view: this.view };
  }

  /** Sets the speed of a member, rpm. With one freedom everything scales; with more the others keep theirs. */
  setSpeed(member: string, n: number, what = "speed"): void {
    const p = this.point;
    const free = Math.max(1, this.operation?.degrees_of_freedom ?? 1);
    const rest = Object.entries(p.speeds).filter(([m]) => m !== member);
    const kept = rest.slice(Math.max(0, rest.length - (free - 1)));
    const speeds = Object.fromEntries([...kept, [member, `${plain(n)} rpm`]]);
    this.move({ ...p, speeds }, what);
  }

  /** Sets the external torque on a member, N m. */
  setTorque(member: string, t: number, what = "torque"): void {
    const p = this.point;
    const given = { ...p.torques, ...p.powers };
    // As many loads as before: the one that is set takes the place of its own power, or of the only one there is.
    const keep = member in given || Object.keys(given).length !== 1 ? p.torques : {};
    const { [member]: _, ...powers } = p.powers;
    const others = member in given || Object.keys(given).length !== 1 ? powers : {};
    this.move({ ...p, torques: { ...keep, [member]: `${plain(t)} N m` }, powers: others }, what);
  }

  gear(name: string): void {
    if (!this.facts || (name === this.point.state && !this.point.engaged)) return;
    this.move(this.inState(name, this.facts, this.point), `gear ${name}`);
  }

  /** Closes an element that is open and opens one that is closed; a known gear is that gear. */
  toggle(element: string): void {
    const facts = this.facts;
    if (!facts) return;
    const opens = this.engaged.includes(element);
    const closed = opens ? this.engaged.filter((e) => e !== element) : [...this.engaged, element];
    const same = facts.states.find((s) => s.engaged.length === closed.length && s.engaged.every((e) => closed.includes(e)));
    this.#remember(this.#step(same ? `gear ${same.name}` : `${element} ${opens ? "opens" : "closes"}`));
    const before = this.operation;
    this.point = { ...NOTHING, state: same?.name ?? null, engaged: same ? null : closed };
    this.refresh();
    // Without an operating point the answer tells how many freedoms there are: so many speeds are given.
    const dof = Object.values(this.view?.analysis?.ratios ?? {})[0]?.degrees_of_freedom ?? 0;
    if (dof === 0) return;
    const [input] = same?.ends ?? facts.ends;
    const order = [...new Set([...(input ? [input] : []), ...facts.terminals, ...facts.members])];
    const told = (w: number | null | undefined) => `${plain(rounded((w ?? 0) * RPM, 4000))} rpm`;
    const load = input ? `${plain(Number((before?.solutions[0]?.members[input]?.torque_n_m ?? 100).toPrecision(6)))} N m` : null;
    // Speeds that are independent of each other: members are tried in order until the library takes them.
    const speeds: Record<string, string> = {};
    for (const m of order) {
      if (Object.keys(speeds).length >= dof) break;
      speeds[m] = told(before?.speeds_rad_s[m] || (m === input ? 1000 / RPM : 0));
      this.point = { ...this.point, speeds: { ...speeds } };
      this.refresh();
      if (this.view?.refused) delete speeds[m];
    }
    // As many terminals as there are freedoms balance the train; only the others have a torque given.
    const given = facts.terminals.length - dof;
    const torques: Record<string, string> = input && load && given > 0 ? { [input]: load } : {};
    const others = facts.terminals.filter((m) => m !== input && m !== facts.ends[1]);
    for (const m of others.slice(0, Math.max(0, given - 1))) torques[m] = "0 N m";
    this.point = { ...this.point, speeds, torques };
    this.refresh();
  }

  say(text: string): void {
    this.spoken = text;
  }
}

export const store = new Store();
