// Design while it is dragged: all trains that do what is wanted, counted as the command line counts them.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { after, before, test } from "node:test";
import { browser, file, open, root, shown, state, studio, willis } from "./studio.mjs";

let at, page;
before(async () => {
  at = await browser();
  page = await studio(at);
});
after(() => at?.close());

const told = (...words) => JSON.parse(execFileSync(willis, [...words, "--top", "100", "--format", "json"], { encoding: "utf8", cwd: root, maxBuffer: 1 << 28 }));
const tab = async () => {
  const own = page.locator('[role="tab"]:text-is("Design")');
  if ((await own.getAttribute("aria-selected")) !== "true" || (await page.locator("#drawer-view").isHidden())) await own.click();
};
/** Waits until what is shown answers the wish. */
const settled = () => page.waitForFunction(() => document.querySelector(".design .found:not(.old), .design .sentence"), null, { timeout: 60_000 });
const rest = async () => {
  await page.waitForTimeout(50);
  await settled();
};
const count = async () => Number((await page.locator(".design .verdict b").first().innerText()).replaceAll("\u2009", ""));
const slide = (label, value) =>
  page.locator(`.design input[aria-label="${label}"]`).evaluate((e, v) => ((e.value = v), e.dispatchEvent(new Event("input", { bubbles: true }))), value);

test("a drive: what is dragged is counted as the command line counts it", { timeout: 120_000 }, async () => {
  await tab();
  await settled();
  const first = told("design", "--kind", "3k", "--ratio", "100", "--tolerance", "0.01", "--ring", "90 mm", "--backward", "0.6");
  assert.equal(await count(), first.waterfall.at(-1).trains);
  assert.match(await page.locator(".design .counts .note").innerText(), /nothing else exists in this space/);
  assert.equal(await page.locator(".design .front .point").count() > 3, true);
  // A row of the table for each point, a stage for each condition.
  assert.equal(await page.locator(".design .list tbody tr").count(), first.rows.length);
  assert.equal(await page.locator(".design .fall tr").count(), first.waterfall.length + 1);
  await slide("backward at least", 820);
  await rest();
  const held = await page.locator('.design input[aria-label="backward at least"]').getAttribute("aria-valuetext");
  const least = await page.evaluate(() => document.querySelector('.design input[aria-label="backward at least"]').value);
  assert.ok(held && least === "820");
  const fewer = await page.locator(".design .verdict").innerText();
  assert.notEqual(fewer, "");
  assert.deepEqual(page.faults, []);
});

test("nothing is left: the wish that must give, gives with a click", { timeout: 120_000 }, async () => {
  await tab();
  await slide("backward at least", 1000);
  await rest();
  assert.match(await page.locator(".design .verdict").innerText(), /No train does it/);
  await page.locator(".design .must button").first().click();
  await rest();
  assert.ok((await count()) >= 1);
  assert.deepEqual(page.faults, []);
});

test("a click loads the row into all panels, and undo brings the train back", { timeout: 120_000 }, async () => {
  await tab();
  const before = (await state(page)).doc.name;
  await page.locator(".design .row").first().click();
  await page.waitForFunction(() => window.__studio.doc.name === "design-1.toml", null, { timeout: 60_000 });
  await shown(page);
  const held = await state(page);
  assert.equal(held.broken, null);
  // The search is about the wish, not about the train that is shown.
  assert.equal(await page.locator(".design tr.shown").count(), 1);
  await page.keyboard.press("Control+z");
  await page.waitForFunction((name) => window.__studio.doc.name === name, before);
  assert.deepEqual(page.faults, []);
});

test("around the train that is shown it is a row itself", { timeout: 120_000 }, async () => {
  await open(page, "zf-8hp70.toml");
  await tab();
  await page.locator(".design [role=radio]", { hasText: "Around this train" }).click();
  await rest();
  await page.waitForSelector(".design .yours, .design .sentence", { timeout: 60_000 });
  assert.equal(await page.locator(".design .yours").count(), 1);
  assert.deepEqual(page.faults, []);
});

test("a design file is written on by hand, and what is wrong in it is said", { timeout: 120_000 }, async () => {
  await tab();
  await page.locator(".design [role=radio]", { hasText: "A design file" }).click();
  const joint = file("examples/design/joint.toml");
  const area = page.locator(".design textarea");
  await area.fill(joint);
  await rest();
  assert.equal(await count(), told("design", "examples/design/joint.toml").waterfall.at(-1).trains);
  await area.fill(joint.replace("backward = 0.6", "backward = 1.6"));
  await page.waitForSelector(".design .sentence", { timeout: 30_000 });
  assert.match(await page.locator(".design .sentence").innerText(), /1\.6/);
  await area.fill(joint);
  await rest();
  // From the wish of the sliders to a file.
  await page.locator(".design [role=radio]", { hasText: "A drive" }).click();
  await rest();
  await page.locator(".design button", { hasText: "As a design file" }).click();
  await page.waitForFunction(() => document.querySelector(".design textarea")?.value.includes("[design]"));
  await rest();
  assert.deepEqual(page.faults, []);
});
