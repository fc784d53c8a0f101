/** Handles of a figure: what can be dragged with a pointer and moved with keys. */

import { figures } from "./numbers";

/** All of it is asked anew each time: a mark stays when the train becomes another, and then stands for something else. */
export interface Handle {
  label: () => string;
  /** What it stands for now, in words. */
  text: () => string;
  /** The value and its limits, in the unit in which it is dragged. */
  value: () => number;
  limits: () => [number, number];
  /** What a pointer means that was moved so many px, from the value where it took hold. */
  place: (from: number, dx: number, dy: number) => number;
  /** Where a key may stop that wants to go there: values between may be impossible. */
  settle?: (to: number, way: number) => number;
  /** A step of the arrow keys. */
  step: () => number;
  begin: () => void;
  /** `exact`: by a key, which goes where it goes and comes back; a pointer stops at round numbers. */
  move: (value: number, exact: boolean) => void;
  end: (back: boolean) => void;
}

const NS = "http://www.w3.org/2000/svg";

const halos = new WeakMap<SVGElement, SVGCircleElement>();
const owners = new WeakMap<Element, SVGElement>();

/** Takes halos away whose marks are no more, as when another train is shown. */
export function tidy(svg: SVGSVGElement): void {
  for (const one of svg.querySelectorAll(".halo")) if (owners.get(one)?.isConnected === false) one.remove();
}

/** Gives a mark a halo: it shows where the mark can be taken, and is large enough for a finger. */
export function halo(mark: SVGElement, x: number, y: number, r: number): void {
  let there = halos.get(mark);
  if (!there) {
    there = document.createElementNS(NS, "circle");
    there.classList.add("halo");
    there.setAttribute("data-ours", "");
    there.addEventListener("pointerdown", (e) => {
      e.stopPropagation();
      mark.dispatchEvent(new PointerEvent("pointerdown", e));
    });
    halos.set(mark, there);
    owners.set(there, mark);
  }
  if (there.nextSibling !== mark) mark.before(there);
  there.setAttribute("cx", String(x));
  there.setAttribute("cy", String(y));
  there.setAttribute("r", String(r));
}

/** An event that was made by a script has no pointer that could be captured. */
function capture(mark: SVGElement, pointer: number): void {
  try {
    mark.setPointerCapture(pointer);
  } catch {
    // It is followed as long as it is over the mark.
  }
}

const sliders = new WeakMap<SVGElement, { tell: () => void; release: () => void }>();

/** Whether a mark is a slider. */
export const isSlider = (mark: SVGElement): boolean => sliders.has(mark);

function set(mark: SVGElement, name: string, value: string): void {
  if (mark.getAttribute(name) !== value) mark.setAttribute(name, value);
}

/** Takes a slider back: what the mark stands for now cannot be dragged. */
export function release(mark: SVGElement): void {
  sliders.get(mark)?.release();
  halos.get(mark)?.remove();
}

/** Makes a mark a slider, or lets the one that it is tell what it stands for now. */
export function slider(mark: SVGElement, handle: () => Handle): void {
  let there = sliders.get(mark);
  if (!there) {
    there = made(mark, handle());
    sliders.set(mark, there);
  }
  there.tell();
}

function made(mark: SVGElement, handle: Handle): { tell: () => void; release: () => void } {
  const tell = () => {
    set(mark, "role", "slider");
    set(mark, "tabindex", "0");
    set(mark, "aria-label", handle.label());
    set(mark, "aria-valuetext", handle.text());
    set(mark, "aria-valuenow", figures(handle.value()).replace("\u2212", "-"));
    mark.classList.add("handle");
  };
  let from: { x: number; y: number; value: number; id: number } | null = null;
  // A step stays what it is while the handle has the focus, however large the value becomes: back is as far as forth.
  let step: number | null = null;
  const unfocus = () => (step = null);
  const clamp = (v: number, free = false) => {
    const [low, high] = handle.limits();
    return free ? v : Math.min(high, Math.max(low, v));
  };
  const down = (e: PointerEvent) => {
    if (e.button !== 0) return;
    e.preventDefault();
    e.stopPropagation();
    capture(mark, e.pointerId);
    mark.focus({ preventScroll: true });
    from = { x: e.clientX, y: e.clientY, value: handle.value(), id: e.pointerId };
    mark.classList.add("on");
    handle.begin();
  };
  const move = (e: PointerEvent) => {
    if (from && e.pointerId === from.id) handle.move(clamp(handle.place(from.value, e.clientX - from.x, e.clientY - from.y), e.altKey), false);
  };
  const up = (e: PointerEvent) => {
    if (from && e.pointerId === from.id) stop(e.type === "pointercancel");
  };
  const stop = (back: boolean) => {
    from = null;
    mark.classList.remove("on");
    handle.end(back);
  };
  const key = (e: KeyboardEvent) => {
    if (e.key === "Escape" && from) {
      stop(true);
      e.stopPropagation();
      return;
    }
    const [low, high] = handle.limits();
    const part = e.shiftKey ? 0.1 : 1;
    const by: Record<string, number> = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10 };
    let to: number | null = null;
    if (e.key in by) to = handle.value() + by[e.key]! * (step ??= handle.step()) * part;
    if (e.key === "Home") to = low;
    if (e.key === "End") to = high;
    if (to === null) return;
    e.preventDefault();
    const wanted = clamp(to);
    const way = Math.sign(wanted - handle.value()) || 1;
    handle.begin();
    handle.move(handle.settle ? handle.settle(wanted, way) : wanted, true);
    handle.end(false);
  };
  mark.addEventListener("pointerdown", down);
  mark.addEventListener("pointermove", move);
  mark.addEventListener("pointerup", up);
  mark.addEventListener("pointercancel", up);
  mark.addEventListener("keydown", key);
  mark.addEventListener("blur", unfocus);
  const release = () => {
    sliders.delete(mark);
    for (const name of ["role", "tabindex", "aria-label", "aria-valuetext", "aria-valuenow", "aria-disabled"]) mark.removeAttribute(name);
    mark.classList.remove("handle", "drag", "along", "on");
    mark.removeEventListener("pointerdown", down);
    mark.removeEventListener("pointermove", move);
    mark.removeEventListener("pointerup", up);
    mark.removeEventListener("pointercancel", up);
    mark.removeEventListener("keydown", key);
    mark.removeEventListener("blur", unfocus);
  };
  return { tell, release };
}
