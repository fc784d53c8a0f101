/** Handles of a figure: what can be dragged with a pointer and moved with keys. */

export interface Handle {
  label: string;
  /** What it stands for now, in words. */
  text: () => string;
  /** The value and its limits, in the unit in which it is dragged. */
  value: () => number;
  limits: () => [number, number];
  /** How much of it one px is. */
  perPixel: () => number;
  /** A step of the arrow keys. */
  step: () => number;
  begin: () => void;
  move: (value: number) => void;
  end: (back: boolean) => void;
}

const NS = "http://www.w3.org/2000/svg";

const halos = new WeakMap<SVGElement, SVGCircleElement>();

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

/** Makes a mark a slider. Returns what takes it back. */
export function slider(mark: SVGElement, handle: Handle): () => void {
  mark.setAttribute("role", "slider");
  mark.setAttribute("tabindex", "0");
  mark.setAttribute("aria-label", handle.label);
  let from: { x: number; value: number; id: number } | null = null;
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
    from = { x: e.clientX, value: handle.value(), id: e.pointerId };
    mark.classList.add("on");
    handle.begin();
  };
  const move = (e: PointerEvent) => {
    if (from && e.pointerId === from.id) handle.move(clamp(from.value + (e.clientX - from.x) * handle.perPixel(), e.altKey));
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
    if (e.key in by) to = handle.value() + by[e.key]! * handle.step() * part;
    if (e.key === "Home") to = low;
    if (e.key === "End") to = high;
    if (to === null) return;
    e.preventDefault();
    handle.begin();
    handle.move(clamp(to));
    handle.end(false);
  };
  mark.addEventListener("pointerdown", down);
  mark.addEventListener("pointermove", move);
  mark.addEventListener("pointerup", up);
  mark.addEventListener("pointercancel", up);
  mark.addEventListener("keydown", key);
  return () => {
    mark.removeEventListener("pointerdown", down);
    mark.removeEventListener("pointermove", move);
    mark.removeEventListener("pointerup", up);
    mark.removeEventListener("pointercancel", up);
    mark.removeEventListener("keydown", key);
  };
}
