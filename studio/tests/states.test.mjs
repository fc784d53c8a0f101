// Each state of the page that is not the usual one: the sentence is there, and the page answers on.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { browser, dots, file, open, page_file, shown, state, studio } from "./studio.mjs";

let at;
before(async () => {
  at = await browser();
});
after(() => at?.close());

/** A page in which something is otherwise from the start. */
async function odd(script, ready = true) {
  const context = await at.newContext({ viewport: { width: 1366, height: 768 }, reducedMotion: "reduce" });
  const page = await context.newPage();
  page.faults = [];
  page.on("pageerror", (e) => page.faults.push(String(e)));
  await page.addInitScript(script);
  await page.goto(pathToFileURL(page_file).href);
  if (ready) {
    await page.waitForFunction(() => window.__ready === true, null, { timeout: 60_000 });
    await shown(page);
  }
  return page;
}

const verdict = (page) => page.locator("#verdict").innerText();

test("loading: the layout is there at once, with strokes for figures", { timeout: 60_000 }, async () => {
  const page = await odd(() => (WebAssembly.compile = () => new Promise(() => {})), false);
  await page.waitForSelector("main #power .waiting");
  const panels = await page.$$eval("main section h2", (all) => all.map((h) => h.textContent));
  assert.deepEqual(panels, ["Train", "Levers", "Why", "Power"]);
  assert.equal(await page.locator("[role=alert]").count(), 0);
  assert.deepEqual(page.faults, []);
  await page.context().close();
});

test("no WebAssembly: it says so, and shows the command line", { timeout: 60_000 }, async () => {
  const page = await odd(() => (WebAssembly.compile = () => Promise.reject(new Error("not here"))), false);
  assert.match(await page.locator("[role=alert]").innerText(), /WebAssembly.*willis analyze/s);
  await page.context().close();
});

test("no train: shelf and new are offered", { timeout: 60_000 }, async () => {
  const broken = { doc: { name: "b.toml", text: "format = 1\nmembers = 3\n", files: {} }, point: {} };
  const page = await odd(`localStorage.setItem("willis-studio", ${JSON.stringify(JSON.stringify(broken))})`);
  assert.match(await page.locator(".none").innerText(), /No train yet/);
  assert.match(await page.locator(".broken").innerText(), /line \d+/);
  await page.locator(".none button", { hasText: "shelf" }).click();
  await page.waitForSelector("#shelf [data-example]");
  await page.keyboard.press("Escape");
  await page.locator(".none button", { hasText: "New" }).click();
  await page.waitForSelector(".none", { state: "detached" });
  await shown(page);
  assert.ok((await dots(page)).length >= 3);
  await page.context().close();
});

test("locked, several answers, out of a law's range, unloaded", { timeout: 120_000 }, async () => {
  const page = await studio(at);
  await open(page, "locked-both-ways.toml");
  assert.match(await verdict(page), /^Locked\./);
  assert.equal(await page.locator("#verdict.bad").count(), 1);

  await open(page, "two-efficiencies.toml");
  assert.match(await verdict(page), /^2 answers\./);
  const held = await state(page);
  const of = async () => [Number(await page.locator("#efficiency").getAttribute("data-value")), await page.locator("#power svg.fig").innerHTML(), await page.locator("#levers svg.fig").innerHTML()];
  const first = await of();
  await page.locator('[aria-label="Answer"] [role=radio]').nth(1).click();
  await page.waitForFunction(() => window.__studio.answer === 1);
  await shown(page);
  const second = await of();
  const eta = held.analysis.operations[0].solutions.map((s) => s.efficiency);
  assert.deepEqual([first[0], second[0]], eta);
  assert.notEqual(first[1], second[1]);
  assert.notEqual(first[2], second[2]);

  await open(page, "wang-herringbone-physical.toml");
  assert.equal(await page.locator("#efficiency.outside").count(), 1);
  assert.match(await page.locator("#why").innerText(), /outside its range/);

  await open(page, "zf-8hp70.toml");
  await page.evaluate(() => window.__studio.setTorque("input", 0));
  await shown(page);
  assert.match(await verdict(page), /^Unloaded\./);
  await page.locator("#why .add button", { hasText: "torque on input" }).click();
  await shown(page);
  assert.match(await verdict(page), /Moves\./);
  assert.deepEqual(page.faults, []);
  await page.context().close();
});

test("an error in the file: its line, the last good train, and the way back", { timeout: 60_000 }, async () => {
  const page = await studio(at);
  await page.evaluate((text) => window.__studio.type(text), file("examples/zf-8hp70.toml").replace("teeth = 48", "teeth = -48"));
  await page.waitForSelector(".broken");
  assert.match(await page.locator(".broken").innerText(), /line \d+/);
  assert.ok((await dots(page)).length > 5);
  assert.ok((await page.evaluate(() => Number(getComputedStyle(document.querySelector("main")).opacity))) < 0.6);
  await page.locator(".broken button", { hasText: "Undo" }).click();
  // Until the answer is there the file counts as broken.
  await page.waitForSelector(".broken", { state: "detached" });
  await shown(page);
  await page.context().close();
});

/** A worker that never answers, and patience that ends soon. */
const DEAF = () => {
  const post = Worker.prototype.postMessage;
  Worker.prototype.postMessage = function (message, ...rest) {
    if (!("question" in message) || window.__hears) post.call(this, message, ...rest);
  };
  const wait = window.setTimeout;
  window.setTimeout = (f, ms, ...rest) => wait(f, ms === 20_000 ? (window.__patience ?? ms) : ms, ...rest);
};

test("slow: what is old is paler, a line runs, and handles answer", { timeout: 60_000 }, async () => {
  const page = await odd(DEAF);
  await page.evaluate(() => (window.__hears = true));
  await page.locator("[role=tab]", { hasText: "Losses" }).click();
  await page.waitForSelector(".picture[aria-busy=false] .sheet svg");
  await page.evaluate(() => (window.__hears = false));
  await page.click('[data-gear="4"]');
  await page.waitForSelector(".picture[aria-busy=true] .line.on");
  assert.equal(await page.locator(".paper.old .sheet svg").count(), 1);
  await page.click('[data-gear="5"]');
  await shown(page);
  assert.equal((await state(page)).point.state, "5");
  await page.context().close();
});

test("a worker that takes too long is ended, and can be asked again", { timeout: 60_000 }, async () => {
  const page = await odd(DEAF);
  await page.evaluate(() => (window.__patience = 100));
  await page.locator("[role=tab]", { hasText: "Losses" }).click();
  await page.waitForSelector(".sentence");
  assert.match(await page.locator(".sentence").innerText(), /stopped after 20 s/i);
  await page.evaluate(() => ((window.__hears = true), (window.__patience = 20_000)));
  await page.locator(".sentence button", { hasText: "Try again" }).click();
  await page.waitForSelector(".picture[aria-busy=false] .sheet svg");
  assert.deepEqual(page.faults, []);
  await page.context().close();
});
