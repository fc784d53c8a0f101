/**
 * A picture of the library in the page: the first time as it is, later only what has changed. Marks stay the same elements while
 * numbers change, so that focus and a drag survive.
 */

const SVG = "http://www.w3.org/2000/svg";

/** Reads a picture as XML of its own: names in it are data and never markup. Its ids get a prefix, since a page has several. */
export function parsed(text: string, prefix: string): SVGSVGElement | null {
  const root = new DOMParser().parseFromString(text, "image/svg+xml").documentElement;
  if (root.namespaceURI !== SVG || root.localName !== "svg") return null;
  for (const one of root.querySelectorAll("[id]")) one.id = `${prefix}-${one.id}`;
  if (text.includes("url(#") || text.includes("href=")) refer(root, prefix);
  return root as unknown as SVGSVGElement;
}

/** References to marks that have other ids now. */
function refer(root: Element, prefix: string): void {
  for (const one of root.querySelectorAll("*")) {
    for (const { name, value } of [...one.attributes]) {
      if (name.endsWith("href") && value.startsWith("#")) one.setAttribute(name, `#${prefix}-${value.slice(1)}`);
      else if (value.includes("url(#")) one.setAttribute(name, value.replaceAll("url(#", `url(#${prefix}-`));
    }
  }
}

/** Attributes that the page gives to marks, which a picture does not know. */
const OURS = new Set(["class", "role", "tabindex", "aria-label", "aria-valuetext", "aria-valuenow", "aria-valuemin", "aria-valuemax", "aria-pressed"]);

const OUR_CLASSES = ["hot", "on", "handle", "drag", "along", "fig"];

function attribute(to: Element, name: string, value: string): void {
  if (name === "class") {
    const own = [...to.classList].filter((c) => OUR_CLASSES.includes(c));
    const all = [value, ...own].join(" ").trim();
    if (to.getAttribute("class") !== all) to.setAttribute("class", all);
  } else if (to.getAttribute(name) !== value) to.setAttribute(name, value);
}

function attributes(to: Element, from: Element): void {
  for (const { name, value } of [...from.attributes]) attribute(to, name, value);
  for (const { name } of [...to.attributes]) if (!from.hasAttribute(name) && !OURS.has(name)) to.removeAttribute(name);
}

const key = (node: Node) => (node instanceof Element ? `${node.localName}#${node.id}` : String(node.nodeType));
const ours = (node: Node) => node instanceof Element && node.hasAttribute("data-ours");

/** Makes one element like another. */
export function morph(to: Element, from: Element): void {
  attributes(to, from);
  let at = to.firstChild;
  const skip = () => {
    while (at && ours(at)) at = at.nextSibling;
  };
  for (const wanted of [...from.childNodes]) {
    skip();
    if (at && key(at) === key(wanted)) {
      if (wanted instanceof Element) morph(at as Element, wanted);
      else if (at.nodeValue !== wanted.nodeValue) at.nodeValue = wanted.nodeValue;
      at = at.nextSibling;
      continue;
    }
    // A mark that moved within its group keeps its element.
    const same = wanted instanceof Element && wanted.id ? find(to, wanted) : null;
    if (same) {
      to.insertBefore(same, at);
      morph(same, wanted as Element);
    } else to.insertBefore(document.importNode(wanted, true), at);
  }
  while (at) {
    const next: ChildNode | null = at.nextSibling;
    if (!ours(at)) at.remove();
    at = next;
  }
}

function find(parent: Element, like: Element): Element | null {
  for (const child of parent.children) if (child.id === like.id && child.localName === like.localName) return child;
  return null;
}

/** A picture that is in the page: its text piece by piece, and the element that each piece begins. */
interface Seen {
  pieces: string[];
  elements: (Element | null)[];
}

const seen = new WeakMap<SVGSVGElement, Seen>();

/** What stands between one `<` and the next. Every opening tag begins an element, in the order of the document. */
function remember(svg: SVGSVGElement, text: string): void {
  const pieces = text.split("<");
  const own = [svg, ...svg.querySelectorAll("*")].filter((e) => !e.closest("[data-ours]"));
  let k = 0;
  const elements = pieces.map((p) => (p === "" || p[0] === "/" || p[0] === "?" || p[0] === "!" ? null : (own[k++] ?? null)));
  if (k === own.length) seen.set(svg, { pieces, elements });
  else seen.delete(svg);
}

const TAG = /^([\w:-]+)((?:\s+[\w:-]+="[^"]*")*)\s*\/?>([^]*)$/;
const ATTRIBUTE = /([\w:-]+)="([^"]*)"/g;
const ENTITIES: Record<string, string> = { lt: "<", gt: ">", amp: "&", quot: '"', apos: "'" };
const plain = (text: string) =>
  text.includes("&") ? text.replace(/&(?:#x([\da-f]+)|#(\d+)|(\w+));/gi, (all, hex, number, name) => (hex ? String.fromCodePoint(parseInt(hex, 16)) : number ? String.fromCodePoint(Number(number)) : (ENTITIES[name] ?? all))) : text;

/** Changes only what is different in the text of the picture, without reading the rest. False where more than values changed. */
function patch(svg: SVGSVGElement, text: string, prefix: string): boolean {
  const old = seen.get(svg);
  const pieces = text.split("<");
  if (!old || old.pieces.length !== pieces.length) return false;
  const changes: [Element, RegExpExecArray, RegExpExecArray][] = [];
  for (let k = 0; k < pieces.length; k++) {
    const [was, now] = [old.pieces[k]!, pieces[k]!];
    if (was === now) continue;
    const element = old.elements[k];
    const [before, after] = [TAG.exec(was), TAG.exec(now)];
    if (!element || !before || !after || before[1] !== after[1]) return false;
    if (before[3] !== after[3] && element.firstChild?.nodeType !== Node.TEXT_NODE) return false;
    changes.push([element, before, after]);
  }
  for (const [element, before, after] of changes) {
    if (before[2] !== after[2]) {
      const left = new Set([...before[2]!.matchAll(ATTRIBUTE)].map((m) => m[1]!));
      for (const [, name, value] of after[2]!.matchAll(ATTRIBUTE)) {
        left.delete(name!);
        let v = plain(value!);
        if (name === "id") v = `${prefix}-${v}`;
        else if (name!.endsWith("href") && v.startsWith("#")) v = `#${prefix}-${v.slice(1)}`;
        else if (v.includes("url(#")) v = v.replaceAll("url(#", `url(#${prefix}-`);
        if (element === svg && name === "role") continue;
        attribute(element, name!, v);
      }
      for (const name of left) if (!OURS.has(name)) element.removeAttribute(name);
    }
    if (before[3] !== after[3]) element.firstChild!.nodeValue = plain(after[3]!);
  }
  seen.set(svg, { pieces, elements: old.elements });
  return true;
}

/** Puts a picture into a box. */
export function show(box: HTMLElement, text: string, prefix: string): SVGSVGElement | null {
  const shown = box.querySelector<SVGSVGElement>(":scope > svg.fig");
  if (shown && patch(shown, text, prefix)) return shown;
  const from = parsed(text, prefix);
  if (!from) return null;
  // There are handles in it.
  from.setAttribute("role", "group");
  if (shown) {
    morph(shown, from);
    shown.classList.add("fig");
    remember(shown, text);
    return shown;
  }
  const made = document.importNode(from, true);
  made.classList.add("fig");
  box.append(made);
  remember(made, text);
  return made;
}

/** Schematic and levers stand under each other and are moved together. */
export function pan(box: HTMLElement): void {
  for (const other of document.querySelectorAll<HTMLElement>("#train .body, #levers .body")) {
    if (other !== box && other.scrollLeft !== box.scrollLeft) other.scrollLeft = box.scrollLeft;
  }
}
