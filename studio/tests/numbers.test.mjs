// The numbers are those of the command line: bit for bit, or to 1e-12 where laws of loss take powers and exponentials, which a
// browser's build has from another library than the program.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { browser, command_line, dots, open, shelf, shown, state, studio } from "./studio.mjs";

let at, page;
before(async () => {
  at = await browser();
  page = await studio(at);
});
after(() => at?.close());

/** Whether the answer that is compared has losses by laws. */
let lawful = false;

/** Where two answers differ first. */
function difference(a, b, place = "") {
  // How fast an iteration converged is the quotient of two differences that are nothing but round-off; what gears cost at a load,
  // and what other laws make of an efficiency, are questions of their own, which a page with one point does not ask.
  if (Object.is(a, b) || /\.(convergence|at_load|band)$/.test(place)) return null;
  // Residuals, W, are the round-off of powers that may be a million times larger.
  if (lawful && place.endsWith("residual_w") && Math.abs(a - b) <= 1e-6) return null;
  if (lawful && typeof a === "number" && typeof b === "number" && Math.abs(a - b) <= 1e-12 * Math.max(Math.abs(a), Math.abs(b), 1)) return null;
  if (a && b && typeof a === "object" && typeof b === "object") {
    for (const key of new Set([...Object.keys(a), ...Object.keys(b)])) {
      const found = difference(a[key], b[key], `${place}.${key}`);
      if (found) return found;
    }
    return null;
  }
  return `${place}: page ${JSON.stringify(a)}, command line ${JSON.stringify(b)}`;
}

async function compare(what) {
  const held = await state(page);
  if (!held.analysis) return `${what}: ${held.refused?.diagnostics[0]?.message ?? held.broken?.diagnostics[0]?.message ?? "no answer"}`;
  const there = await command_line(page);
  lawful = there.operations.some((o) => o.solutions.some((s) => s.sources?.length));
  const wrong = difference(held.analysis, there);
  if (wrong) return `${what}: ${wrong}`;
  const speeds = there.operations[0]?.speeds_rad_s;
  if (!speeds) return null;
  for (const [member, value] of await dots(page)) {
    if (member in speeds && speeds[member] !== null && difference(value, speeds[member])) return `${what}: dot of ${member}: ${value}, command line ${speeds[member]}`;
  }
  return null;
}

test("every example on the shelf", { timeout: 600_000 }, async () => {
  const names = await shelf(page);
  assert.ok(names.length >= 30, `${names.length} examples`);
  const wrong = [];
  for (const name of names) {
    await open(page, name);
    wrong.push(await compare(name));
  }
  assert.deepEqual(wrong.filter(Boolean), []);
  assert.deepEqual(page.faults, []);
});

test("every gear of an automatic, at odd speeds and torques", { timeout: 300_000 }, async () => {
  await open(page, "zf-8hp70.toml");
  const gears = await page.evaluate(() => window.__studio.facts.states.map((s) => s.name));
  const wrong = [];
  for (const gear of gears) {
    await page.evaluate((gear) => {
      const s = window.__studio;
      s.gear(gear);
      s.setSpeed(s.input, 1234.56789);
      s.setTorque(s.input, 98.7654321);
    }, gear);
    await shown(page);
    assert.ok((await dots(page)).length > 5);
    wrong.push(await compare(`gear ${gear}`));
  }
  assert.deepEqual(wrong.filter(Boolean), []);
});

test("all panels show one frame", async () => {
  for (let k = 0; k < 20; k++) {
    await page.evaluate((k) => window.__studio.setSpeed(window.__studio.input, 900 + 37 * k), k);
    const seen = await page.evaluate(
      () =>
        new Promise((done) =>
          requestAnimationFrame(() => requestAnimationFrame(() => done([...document.querySelectorAll("main section[data-generation]")].map((p) => p.dataset.generation)))),
        ),
    );
    assert.equal(seen.length, 4);
    assert.equal(new Set(seen).size, 1, seen.join(" "));
  }
});
