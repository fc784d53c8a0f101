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

function attributes(to: Element, from: Element): void {
  for (const { name, value } of [...from.attributes]) {
    if (name === "class") {
      const own = [...to.classList].filter((c) => ["hot", "on", "handle", "drag"].includes(c));
      const all = [value, ...own].join(" ").trim();
      if (to.getAttribute("class") !== all) to.setAttribute("class", all);
    } else if (to.getAttribute(name) !== value) to.setAttribute(name, value);
  }
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

/** Puts a picture into a box. */
export function show(box: HTMLElement, text: string, prefix: string): SVGSVGElement | null {
  const from = parsed(text, prefix);
  if (!from) return null;
  // There are handles in it.
  from.setAttribute("role", "group");
  const there = box.querySelector<SVGSVGElement>(":scope > svg.fig");
  if (there) {
    morph(there, from);
    there.classList.add("fig");
    return there;
  }
  const made = document.importNode(from, true);
  made.classList.add("fig");
  box.append(made);
  return made;
}

/** Schematic and levers stand under each other and are moved together. */
export function pan(box: HTMLElement): void {
  for (const other of document.querySelectorAll<HTMLElement>("#train .body, #levers .body")) {
    if (other !== box && other.scrollLeft !== box.scrollLeft) other.scrollLeft = box.scrollLeft;
  }
}
