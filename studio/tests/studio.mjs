// What the tests share: the page in a browser, opened from its file, and the command line beside it.
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

export const root = resolve(dirname(fileURLToPath(import.meta.url)), "../..");
const built = [join(root, "target/studio.html"), join(root, "studio/dist/index.html")];
export const page_file = process.env.STUDIO ?? built.find(existsSync) ?? built[0];
export const willis = process.env.WILLIS ?? join(root, "target/release/willis");
const browser_file = process.env.CHROMIUM ?? "/usr/bin/chromium";

/** A browser for a file of tests. */
export async function browser() {
  return chromium.launch({ executablePath: browser_file, args: ["--no-sandbox", "--js-flags=--expose-gc", "--enable-precise-memory-info"] });
}

/** The page, ready. What goes wrong in it goes wrong in the test. */
export async function studio(at, { width = 1366, height = 768, hash = "", url = pathToFileURL(page_file).href, ...options } = {}) {
  const context = await at.newContext({ viewport: { width, height }, reducedMotion: "reduce", ...options });
  const page = await context.newPage();
  page.faults = [];
  page.requests = [];
  page.on("pageerror", (e) => page.faults.push(String(e)));
  page.on("console", (m) => m.type() === "error" && page.faults.push(m.text()));
  page.on("request", (r) => page.requests.push(r.url()));
  await page.goto(url + hash);
  await page.waitForFunction(() => window.__ready === true, null, { timeout: 60_000 });
  await shown(page);
  return page;
}

/** Opens an example from the shelf. */
export async function open(page, name) {
  await page.click("#file");
  await page.click(`[data-example="${name}"]`);
  await page.waitForFunction((name) => window.__studio.doc.name === name, name);
  await shown(page);
}

/** Waits until all panels that are seen show the frame of the state. */
export async function shown(page) {
  await page.waitForFunction(async () => {
    await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    const s = window.__studio;
    if (!s.view || s.broken) return true;
    const seen = [...document.querySelectorAll("main section[data-generation]")].filter((p) => p.getClientRects().length > 0);
    return seen.every((p) => Number(p.dataset.generation) === s.view.generation);
  }, null, { timeout: 20_000 });
}

/** What the store holds. */
export function state(page) {
  return page.evaluate(() => {
    const s = window.__studio;
    const held = { doc: s.doc, point: s.point, operation: s.view?.operation ?? null, state: s.view?.state ?? null };
    return { ...held, analysis: s.view?.analysis ?? null, refused: s.view?.refused ?? null, broken: s.broken };
  });
}

/** The answer of the command line for what the page would save; tables of the examples lie beside it. */
export async function command_line(page) {
  const { text, operation, state: gear, files } = await page.evaluate(() => {
    const s = window.__studio;
    return { text: s.exported(), operation: s.view?.operation ?? null, state: s.view?.state ?? null, files: { ...s.doc.files } };
  });
  const folder = mkdtempSync(join(tmpdir(), "studio-"));
  try {
    for (const [name, table] of Object.entries(files)) writeFileSync(join(folder, name), table);
    const file = join(folder, "train.toml");
    writeFileSync(file, text);
    const which = operation ? ["--operation", operation] : gear ? ["--state", gear] : [];
    const out = execFileSync(willis, ["analyze", file, ...which, "--format", "json"], { encoding: "utf8", maxBuffer: 1 << 28 });
    return JSON.parse(out);
  } finally {
    rmSync(folder, { recursive: true });
  }
}

/** `member: [values of its dots]`, as text. */
export function dots(page) {
  return page.evaluate(() =>
    [...document.querySelectorAll("#levers svg.fig circle[data-value][data-member]:not([data-ours])")].map((d) => [d.dataset.member, Number(d.dataset.value)]),
  );
}

/** Names of the examples on the shelf. */
export async function shelf(page) {
  await page.click("#file");
  const names = await page.$$eval("[data-example]", (all) => all.map((e) => e.dataset.example));
  await page.keyboard.press("Escape");
  return names;
}

/** A random number that is the same in every run. */
export function dice(seed = 1841) {
  let s = seed >>> 0;
  return () => {
    s = (s + 0x6d2b79f5) >>> 0;
    let t = Math.imul(s ^ (s >>> 15), 1 | s);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

export function file(name) {
  return readFileSync(join(root, name), "utf8");
}
