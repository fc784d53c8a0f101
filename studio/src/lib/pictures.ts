/** Figures of the library in the page, and the way from their places to values. */

import { parsed } from "./morph";

export interface Drawn {
  svg: SVGSVGElement;
  /** Of what is shown, px; marks over the figure take the same. */
  width: number;
  height: number;
  viewBox: string;
}

/** Elements that a figure has; whatever else stood in one would not be ours. */
const KNOWN = new Set(
  "svg g path rect line circle ellipse polygon polyline text tspan title desc defs clipPath pattern marker style linearGradient stop use mask animateTransform animate".split(" "),
);

const n = (e: Element, name: string) => Number(e.getAttribute(name));

/**
 * The SVG of a figure as an element. Nothing that could act or load is in it, and the ground is left out: a figure lies on its
 * panel.
 */
export function drawn(text: string, prefix: string): Drawn | null {
  const read = parsed(text, prefix.replace(/[^\w-]/g, "-"));
  if (!read || read.querySelector("parsererror")) return null;
  const svg = document.importNode(read, true);
  for (const e of svg.querySelectorAll("*")) {
    if (!KNOWN.has(e.localName)) e.remove();
    for (const { name, value } of [...e.attributes]) {
      if (name.startsWith("on") || (name.endsWith("href") && !value.startsWith("#"))) e.removeAttribute(name);
    }
  }
  const [, , width = 0, height = 0] = (svg.getAttribute("viewBox") ?? "").split(/[\s,]+/).map(Number);
  const ground = svg.querySelector(":scope > rect");
  if (ground && Number(ground.getAttribute("height")) >= height) ground.setAttribute("fill", "none");
  // What the figure is, is its name; what it shows, its description.
  const title = svg.querySelector(":scope > title");
  if (title) {
    svg.setAttribute("aria-label", title.textContent ?? "");
    title.remove();
  }
  // Nor is there room for a heading that the page has already; a line below it stays.
  const heading = svg.querySelector(':scope > text[font-size="20"], :scope > g > text[font-size="20"], :scope > g > g > text[font-size="20"]');
  const top = heading && n(heading, "y") < 50 ? n(heading, "y") + 6 : 0;
  if (top > 0) heading!.remove();
  const viewBox = `0 ${top} ${width} ${height - top}`;
  svg.setAttribute("viewBox", viewBox);
  svg.setAttribute("height", String(height - top));
  return { svg, width, height: height - top, viewBox };
}

/** Where a pointer is, in the figure's own px. */
export function pointer(e: PointerEvent): [number, number] {
  const over = (e.currentTarget as SVGElement).ownerSVGElement!;
  const box = over.getBoundingClientRect();
  return [e.clientX - box.left + over.viewBox.baseVal.x, e.clientY - box.top + over.viewBox.baseVal.y];
}

export interface Box {
  left: number;
  top: number;
  right: number;
  bottom: number;
}

/** Frames of the charts in a figure, from top to bottom. */
export function frames(svg: SVGSVGElement): Box[] {
  return [...svg.querySelectorAll('rect[fill="none"][stroke]')]
    .map((e) => ({ left: n(e, "x"), top: n(e, "y"), right: n(e, "x") + n(e, "width"), bottom: n(e, "y") + n(e, "height") }))
    .filter((b) => b.right - b.left > 100 && b.bottom - b.top > 60)
    .sort((a, b) => a.top - b.top);
}

/** A straight scale: the value at a place is `a + b * place`. */
export interface Scale {
  at(place: number): number;
  of(value: number): number;
}

function straight(points: [number, number][]): Scale | null {
  const [first, last] = [points[0], points.at(-1)];
  if (!first || !last || first[0] === last[0] || first[1] === last[1]) return null;
  const slope = (last[1] - first[1]) / (last[0] - first[0]);
  return { at: (p) => first[1] + slope * (p - first[0]), of: (v) => first[0] + (v - first[1]) / slope };
}

/** A number as figures write it. */
function read(text: string | null): number {
  const plain = (text ?? "").trim().replace(/\u2212/g, "-").replace(/[\s\u2009\u202f]/g, "");
  return plain === "" ? NaN : Number(plain);
}

/** The scales of a chart, from the numbers at its frame. */
export function scales(svg: SVGSVGElement, frame: Box): { x: Scale; y: Scale } | null {
  const texts = [...svg.querySelectorAll("text")].map((e) => ({ e, x: n(e, "x"), y: n(e, "y"), value: read(e.textContent) }));
  const numbers = texts.filter((t) => Number.isFinite(t.value));
  const below = numbers.filter(
    (t) => t.e.getAttribute("text-anchor") === "middle" && Math.abs(t.y - frame.bottom - 16) < 4 && t.x > frame.left - 2 && t.x < frame.right + 2,
  );
  // The numbers beside it stand with their middle, not their base line, at the value.
  const beside = numbers.filter(
    (t) => t.e.getAttribute("text-anchor") === "end" && Math.abs(t.x - frame.left + 7) < 4 && t.y > frame.top - 2 && t.y < frame.bottom + 10,
  );
  const x = straight(below.map((t) => [t.x, t.value] as [number, number]).sort((a, b) => a[0] - b[0]));
  const y = straight(beside.map((t) => [t.y - 4, t.value] as [number, number]).sort((a, b) => a[0] - b[0]));
  return x && y ? { x, y } : null;
}
