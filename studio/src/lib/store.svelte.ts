/**
 * One state for all panels: the text of the file, the point, and what the library says of both. Every change is a step that can
 * be taken back; a drag is one step.
 */

import { RPM, figures, plain } from "./numbers";
import { Session, refusal, refused } from "./willis";
import type { Analysis, Boxes, Closed, Doc, Facts, Frame, Look, OperationReport, Point, Refusal, Solution } from "./types";

export interface Step {
  doc: Doc;
  point: Point;
  /** The time of a run whose speeds the point has, s. */
  moment: number | null;
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

function told(x: number | null | undefined, factor: number, unit: string): string | null {
  return x ? `${plain(Number((x * factor).toPrecision(6)))} ${unit}` : null;
}

const PLAIN: Look = { answer: 0, seen_from: null, losses: null };

class Store {
  doc = $state.raw<Doc>({ name: "", text: "", files: {} });
  point = $state.raw<Point>(NOTHING);
  facts = $state.raw<Facts | null>(null);
  /** What is wrong with the text; panels keep the last good train. */
  broken = $state.raw<Refusal | null>(null);
  view = $state.raw<View | null>(null);
  boxes = $state.raw<Boxes>({ width: 700, stick: 300, lever: 260, power: [640, 280], scale: null, ...PLAIN });
  hovered = $state<string | null>(null);
  /** The member of which everything is shown. */
  inspected = $state<string | null>(null);
  /** Something is dragged: scales stay. */
  dragging = $state(false);
  /** What is compared with what is shown. */
  pinned = $state.raw<{ state: string | null; solution: Solution | null } | null>(null);
  /** The time of a run whose speeds are shown, s. */
  moment = $state<number | null>(null);
  labels = $state<"speed" | "torque">("speed");
  /** What the live region says. */
  spoken = $state("");

  #session: Session | null = null;
  #past = $state.raw<Step[]>([]);
  #future = $state.raw<Step[]>([]);
  #before: Step | null = null;
  #typed = -Infinity;
  #generation = 0;
  #frame = 0;

  canUndo = $derived(this.#past.length > 0);
  canRedo = $derived(this.#future.length > 0);

  get operation(): OperationReport | null {
    return this.view?.analysis?.operations[0] ?? null;
  }

  /** The equilibrium that is shown, of several perhaps. */
  get solution(): Solution | null {
    return this.operation?.solutions[this.answer] ?? null;
  }

  get answer(): number {
    return Math.max(0, Math.min(this.boxes.answer, (this.operation?.solutions.length ?? 1) - 1));
  }

  get look(): Look {
    const { answer, seen_from, losses } = this.boxes;
    return { answer, seen_from, losses };
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
    return { doc: this.doc, point: this.point, moment: this.moment, what };
  }

  #remember(step: Step): void {
    this.#past = [...this.#past.slice(1 - MOST_STEPS), step];
    this.#future = [];
  }

  /** Opens a file; the first operation of it, or its first gear, is shown. */
  open(doc: Doc, point?: Point, look: Partial<Look> = {}): boolean {
    if (this.facts) this.#remember(this.#step("open"));
    this.pinned = null;
    this.boxes = { ...this.boxes, ...PLAIN, ...look };
    const good = this.#read(doc);
    this.point = point ?? (this.facts ? this.#first(this.facts) : NOTHING);
    this.refresh();
    return good;
  }

  #read(doc: Doc): boolean {
    this.doc = doc;
    // Another train runs otherwise.
    this.moment = null;
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
    return { ...NOTHING, state: name, speeds: { [input]: this.#speed(input, from) ?? "1000 rpm" }, ...this.#load(input, from) };
  }

  /** The speed of a member as it was given, else as it is shown; none where it stands still. */
  #speed(member: string, from: Point): string | null {
    return from.speeds[member] ?? told(this.operation?.speeds_rad_s[member], RPM, "rpm");
  }

  /** The load of the input as it was given, else as it is shown; none where it is no terminal, as a machine of a variator. */
  #load(input: string, from: Point): Pick<Point, "torques" | "powers"> {
    if (!this.facts?.terminals.includes(input)) return { torques: {}, powers: {} };
    const power = from.powers[input];
    if (power) return { torques: {}, powers: { [input]: power } };
    const torque = from.torques[input] ?? told(this.solution?.members[input]?.torque_n_m, 1, "N m") ?? "100 N m";
    return { torques: { [input]: torque }, powers: {} };
  }

  /** Changes the point; `merge` while something is dragged. */
  move(point: Point, what: string): void {
    if (!this.dragging) this.#remember(this.#step(what));
    this.moment = null;
    this.point = point;
    this.later();
  }

  /** A drag begins. */
  grab(what: string, scale: Boxes["scale"] = this.view?.frame?.scale ?? null): void {
    this.#before = this.#step(what);
    this.dragging = true;
    this.boxes = { ...this.boxes, scale };
  }

  /** It ends; taken back, everything is as before. */
  drop(back = false): void {
    const before = this.#before;
    this.#before = null;
    this.dragging = false;
    this.boxes = { ...this.boxes, scale: null };
    if (!before) return;
    if (back) {
      if (before.doc !== this.doc) this.#read(before.doc);
      this.#back(before);
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

  /** What an edit would be refused for; nothing changes. */
  check(change: (session: Session) => string): Refusal | null {
    if (!this.#session || this.broken) return this.broken;
    try {
      change(this.#session);
      return null;
    } catch (thrown) {
      return refusal(thrown);
    }
  }

  /** What the library knows of the train at hand without being asked at length. */
  tell<T>(of: (session: Session) => string): T | null {
    return this.#session && !this.broken ? (JSON.parse(of(this.#session)) as T) : null;
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
    this.#back(step);
    this.refresh();
  }

  #back(step: Step): void {
    this.point = step.point;
    this.moment = step.moment;
  }

  /** Shows with the next frame; moves in between are one. */
  later(): void {
    if (this.#frame) return;
    this.#frame = requestAnimationFrame(() => {
      this.#frame = 0;
      this.refresh();
    });
  }

  /** What waits for the next frame is done now: keys come faster than frames. */
  now(): void {
    if (!this.#frame) return;
    cancelAnimationFrame(this.#frame);
    this.#frame = 0;
    this.refresh();
  }

  /** How the point is shown: which answer, from where, how wide losses. No step: nothing of the train changes. */
  show(look: Partial<Look>): void {
    this.resize(look);
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
        lever: wrong ? (this.view?.lever ?? "") : shown.lever || (this.view?.lever ?? ""),
        power: wrong ? (this.view?.power ?? "") : shown.power || (this.view?.power ?? ""),
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
    this.pinned = this.pinned || !this.view ? null : { state: this.view.state, solution: this.solution };
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
    if (!this.facts || (name === this.point.state && !this.point.engaged && this.moment === null)) return;
    this.move(this.inState(name, this.facts, this.point), `gear ${name}`);
  }

  #toggled: { element: string; from: Step; to: Point } | null = null;

  /** Closes an element that is open and opens one that is closed; a known gear is that gear. */
  toggle(element: string): void {
    if (!this.facts || this.broken) return;
    const opens = this.engaged.includes(element);
    const closed = opens ? this.engaged.filter((e) => e !== element) : [...this.engaged, element];
    const from = this.point;
    const is = this.#closed(closed, this.facts.members);
    const step = this.#step(is.state ? `gear ${is.state}` : `${element} ${opens ? "opens" : "closes"}`);
    this.#remember(step);
    const last = this.#toggled;
    // The same one back at once is as it was before, also where it stood still in between.
    if (last?.element === element && last.to === from && last.from.doc === this.doc) this.#back(last.from);
    else this.#close(closed, is, from);
    this.#toggled = { element, from: step, to: this.point };
    this.refresh();
  }

  /** A gear that the table does not have, or not yet: it stays one by hand, also where it is one of the table. */
  invent(closed: string[], what: string): void {
    if (!this.facts || this.broken) return;
    const from = this.point;
    const is = this.#closed(closed, this.facts.members);
    this.#remember(this.#step(what));
    this.#close(closed, { ...is, state: null }, from);
    this.refresh();
  }

  /** The point with these elements closed: members that settle the train turn as they did, terminals carry what they carried. */
  #close(closed: string[], is: Closed, from: Point): void {
    const speeds = is.speeds.map((m, k) => [m, this.#speed(m, from) ?? (k === 0 ? "1000 rpm" : "0 rpm")]);
    const [input] = is.ends;
    const load = input ? this.#load(input, from) : { torques: {}, powers: {} };
    // Another terminal keeps what it carried, torque or power.
    const kept = (m: string) => (m in from.powers ? { torques: {}, powers: { [m]: from.powers[m]! } } : { torques: { [m]: from.torques[m] ?? "0 N m" }, powers: {} });
    this.#set(closed, is, speeds, (m) => (m === input ? load : kept(m)));
  }

  /** What the train is with these elements closed; members whose speeds are known settle the others. */
  #closed(closed: string[], known: string[]): Closed {
    return JSON.parse(this.#session!.closed(closed, known)) as Closed;
  }

  /** The point with these elements closed, these speeds, and a load on every terminal that does not balance the train. */
  #set(closed: string[], is: Closed, speeds: string[][], load: (terminal: string) => Pick<Point, "torques" | "powers">): void {
    // What does not turn takes no load.
    const loads = speeds.length ? is.torques.map(load) : [];
    const [torques, powers] = [Object.assign({}, ...loads.map((l) => l.torques)), Object.assign({}, ...loads.map((l) => l.powers))];
    this.point = { ...NOTHING, state: is.state, engaged: is.state ? null : closed, speeds: Object.fromEntries(speeds), torques, powers };
    this.moment = null;
  }

  /** A moment of a run: what is closed, speeds in rad/s, and the torque of what drives the input. The panels show its steady state. */
  at(moment: number, closed: string[], speeds: Record<string, number>, torque: number | null): void {
    if (!this.facts || this.broken) return;
    const is = this.#closed(closed, Object.keys(speeds));
    const given = is.speeds.filter((m) => m in speeds).map((m) => [m, `${plain(Number((speeds[m]! * RPM).toPrecision(7)))} rpm`]);
    const [input] = is.ends;
    const load = input === null ? null : torque === null ? this.#load(input, this.point) : { torques: { [input]: `${plain(Number(torque.toPrecision(6)))} N m` }, powers: {} };
    this.#set(closed, is, given, (m) => (m === input && load ? load : { torques: { [m]: "0 N m" }, powers: {} }));
    this.moment = moment;
    this.later();
  }

  say(text: string): void {
    this.spoken = text;
  }
}

export const store = new Store();
