/** The editor of train files: colours, keys, completion from the schema, diagnostics with their fixes. */

import { autocompletion, completionKeymap, type Completion, type CompletionContext, type CompletionResult } from "@codemirror/autocomplete";
import { defaultKeymap } from "@codemirror/commands";
import { HighlightStyle, StreamLanguage, bracketMatching, syntaxHighlighting } from "@codemirror/language";
import { toml } from "@codemirror/legacy-modes/mode/toml";
import { lintGutter, lintKeymap, type Diagnostic } from "@codemirror/lint";
import { Annotation, type EditorState, type Extension } from "@codemirror/state";
import { EditorView, drawSelection, highlightActiveLine, keymap, lineNumbers } from "@codemirror/view";
import { tags } from "@lezer/highlight";
import { fileSchema } from "../wasm/willis_web.js";

interface Place {
  start: number;
  end: number;
  line?: number;
  column?: number;
  end_line?: number;
  end_column?: number;
}

/** A diagnostic of the library, with all that its place has. */
export interface Note {
  code: string;
  severity: "error" | "warning" | "note";
  message: string;
  hints: string[];
  span?: Place | null;
  replacement?: unknown;
}

/** The text came from outside: it is no step of the user. */
const outside = Annotation.define<boolean>();

/** Makes the text what it is elsewhere by the difference alone, so that the cursor stays. */
export function follow(view: EditorView, text: string): void {
  const now = view.state.doc.toString();
  if (now === text) return;
  let from = 0;
  while (from < now.length && from < text.length && now[from] === text[from]) from += 1;
  let [a, b] = [now.length, text.length];
  while (a > from && b > from && now[a - 1] === text[b - 1]) [a, b] = [a - 1, b - 1];
  view.dispatch({ changes: { from, to: a, insert: text.slice(from, b) }, annotations: outside.of(true) });
}

/** Lines and columns count characters from 1; the editor counts units of UTF-16. */
function offset(state: EditorState, line: number, column: number): number {
  const own = state.doc.line(Math.min(Math.max(1, line), state.doc.lines));
  const before = [...own.text].slice(0, Math.max(0, column - 1)).join("");
  return own.from + before.length;
}

/** Diagnostics at their places; what has none stands at the start. */
export function notes(state: EditorState, all: Note[]): Diagnostic[] {
  return all.map((d) => {
    const { line, column, end_line, end_column } = d.span ?? {};
    const from = line !== undefined ? offset(state, line, column ?? 1) : 0;
    const to = end_line !== undefined ? offset(state, end_line, end_column ?? 1) : from;
    const text = typeof d.replacement === "string" ? d.replacement : null;
    const replace = (view: EditorView, a: number, b: number) => view.dispatch({ changes: { from: a, to: b, insert: text ?? "" } });
    return {
      from,
      to: Math.max(from, to),
      severity: d.severity === "note" ? "info" : d.severity,
      source: d.code,
      message: [d.message, ...d.hints].join("\n"),
      actions: text !== null && d.span ? [{ name: `write ${text}`, apply: replace }] : [],
    };
  });
}

// ---------- completion

type Node = Record<string, any>;
let schema: Node | null = null;

/** Everything that a place of the schema may be: its alternatives, and what its references and lists hold. */
function* alternatives(node: Node | undefined, depth = 0): Generator<Node> {
  if (!node || depth > 8) return;
  schema ??= JSON.parse(fileSchema()) as Node;
  yield node;
  if (typeof node.$ref === "string") {
    const found = node.$ref.split("/").slice(1).reduce((at: Node | undefined, key: string) => at?.[key], schema);
    yield* alternatives(found, depth + 1);
  }
  for (const name of ["allOf", "anyOf", "oneOf"]) for (const one of (node[name] as Node[] | undefined) ?? []) yield* alternatives(one, depth + 1);
  for (const name of ["then", "else", "items"]) yield* alternatives(node[name] as Node | undefined, depth + 1);
}

function member(node: Node, key: string): Node {
  return { anyOf: [...alternatives(node)].flatMap((n) => n.properties?.[key] ?? (typeof n.additionalProperties === "object" ? [n.additionalProperties] : [])) };
}

function keys(node: Node): Completion[] {
  const found = new Map<string, Completion>();
  for (const n of alternatives(node)) {
    for (const [label, own] of Object.entries((n.properties ?? {}) as Record<string, Node>)) {
      const told = [...alternatives(own)].find((a) => a.description)?.description as string | undefined;
      if (!found.has(label) || !found.get(label)!.info) found.set(label, { label, type: "property", ...(told ? { info: told } : {}) });
    }
  }
  return [...found.values()];
}

/** The keys that lead to a place in the text: those of the table, and of the braces that are open. */
function path(before: string): { table: string[]; open: string[] } {
  const heads = [...before.matchAll(/^[ \t]*\[\[?([^\]\n]+)\]\]?/gm)];
  const table = heads.at(-1)?.[1]?.split(".").map((k) => k.trim().replace(/^"|"$/g, "")) ?? [];
  const rest = before.slice((heads.at(-1)?.index ?? 0) + (heads.at(-1)?.[0].length ?? 0));
  const open: string[] = [];
  // Strings and comments have no keys.
  const plain = rest.replace(/"(?:[^"\\\n]|\\.)*"/g, (s) => " ".repeat(s.length)).replace(/#[^\n]*/g, (s) => " ".repeat(s.length));
  for (const m of plain.matchAll(/([\w.-]+)?\s*=?\s*(\{)|(\})/g)) m[2] ? open.push(m[1] ?? "") : open.pop();
  return { table, open: open.flatMap((k) => (k ? k.split(".") : [])) };
}

function complete(context: CompletionContext, names: () => string[]): CompletionResult | null {
  const before = context.state.sliceDoc(0, context.pos);
  const line = before.slice(before.lastIndexOf("\n") + 1);
  if (/^[^"]*(?:"[^"]*"[^"]*)*#/.test(line)) return null;
  schema ??= JSON.parse(fileSchema()) as Node;

  const head = /^\s*\[\[?([\w.]*)$/.exec(line);
  if (head) {
    const list = line.includes("[[");
    const fits = keys(schema).filter((k) => [...alternatives(schema!.properties[k.label])].some((n) => n.type === (list ? "array" : "object")));
    return { from: context.pos - head[1]!.length, options: fits };
  }

  const { table, open } = path(before);
  const node = [...table, ...open].reduce(member, schema);

  const quoted = /([\w.]+)\s*=\s*(?:\[[^\]]*)?"([^"\n]*)$/.exec(line) ?? /()"([^"\n]*)$/.exec(line);
  const within = (line.match(/"/g)?.length ?? 0) % 2 === 1;
  if (within && quoted) {
    const at = quoted[1] ? quoted[1].split(".").reduce(member, node) : {};
    const words = [...alternatives(at)].flatMap((n) => (n.enum as unknown[] | undefined) ?? (n.const !== undefined ? [n.const] : []));
    const told = words.filter((w): w is string => typeof w === "string");
    const options = told.length ? told.map((label) => ({ label, type: "enum" })) : names().map((label) => ({ label, type: "variable" }));
    return { from: context.pos - quoted[2]!.length, options };
  }

  const word = context.matchBefore(/[\w.-]*/);
  const starts = /(?:^|[{,])\s*[\w.-]*$/.test(line);
  if (!word || !starts || (word.from === word.to && !context.explicit)) return null;
  return { from: word.from, options: keys(node).map((k) => ({ ...k, apply: `${k.label} = ` })) };
}

// ---------- look

const colours = HighlightStyle.define([
  { tag: tags.comment, color: "var(--fg-3)", fontStyle: "italic" },
  { tag: tags.string, color: "var(--good)" },
  { tag: [tags.number, tags.atom, tags.bool], color: "var(--warn)" },
  { tag: [tags.propertyName, tags.definition(tags.propertyName)], color: "var(--fg)" },
  { tag: [tags.bracket, tags.keyword, tags.heading], color: "var(--act)", fontWeight: "600" },
]);

const look = EditorView.theme({
  "&": { fontSize: "var(--t3)", color: "var(--fg)", backgroundColor: "var(--panel)" },
  ".cm-scroller": { fontFamily: "var(--mono)", lineHeight: "1.5" },
  ".cm-content": { caretColor: "var(--fg)" },
  ".cm-cursor": { borderLeftColor: "var(--fg)" },
  "&.cm-focused": { outline: "2px solid var(--act)", outlineOffset: "-2px" },
  ".cm-gutters": { backgroundColor: "var(--sunk)", color: "var(--fg-3)", border: "0" },
  ".cm-activeLine": { backgroundColor: "color-mix(in srgb, var(--act) 6%, transparent)" },
  ".cm-activeLineGutter": { backgroundColor: "transparent" },
  "&.cm-focused > .cm-scroller > .cm-selectionLayer .cm-selectionBackground, .cm-selectionBackground": { background: "var(--act-soft)" },
  ".cm-tooltip": { backgroundColor: "var(--panel)", color: "var(--fg)", border: "1px solid var(--line)", borderRadius: "var(--r1)", boxShadow: "var(--shadow)" },
  ".cm-tooltip-autocomplete > ul > li[aria-selected]": { backgroundColor: "var(--act)", color: "var(--on-act)" },
  ".cm-diagnostic": { whiteSpace: "pre-wrap", maxWidth: "60em" },
  ".cm-diagnosticAction": { backgroundColor: "var(--act)", color: "var(--on-act)", minHeight: "24px" },
});

export interface Uses {
  typed: (text: string) => void;
  undo: () => void;
  redo: () => void;
  names: () => string[];
}

export function plugins(uses: Uses): Extension[] {
  const done = (what: () => void) => () => {
    what();
    return true;
  };
  return [
    lineNumbers(),
    drawSelection(),
    highlightActiveLine(),
    bracketMatching(),
    lintGutter(),
    StreamLanguage.define(toml),
    syntaxHighlighting(colours),
    autocompletion({ override: [(c) => complete(c, uses.names)], icons: false }),
    keymap.of([
      { key: "Mod-z", run: done(uses.undo), stopPropagation: true },
      { key: "Mod-y", mac: "Mod-Shift-z", run: done(uses.redo), stopPropagation: true },
      { key: "Mod-Shift-z", run: done(uses.redo), stopPropagation: true },
      ...completionKeymap,
      ...lintKeymap,
      ...defaultKeymap,
    ]),
    EditorView.contentAttributes.of({ "aria-label": "Train file", tabindex: "0" }),
    EditorView.updateListener.of((update) => {
      if (update.docChanged && !update.transactions.some((t) => t.annotation(outside))) uses.typed(update.state.doc.toString());
    }),
    look,
  ];
}
