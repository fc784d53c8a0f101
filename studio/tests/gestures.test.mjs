// Each gesture, with a pointer and with keys.
import assert from "node:assert/strict";
import { after, before, beforeEach, test } from "node:test";
import { browser, command_line, dots, open, shown, state, studio } from "./studio.mjs";

let at, page;
before(async () => {
  at = await browser();
  page = await studio(at);
});
after(() => at?.close());
beforeEach(async () => {
  // Whatever the test before left behind.
  await page.mouse.up();
  await page.keyboard.press("Escape");
  await open(page, "zf-8hp70.toml");
  page.faults.length = 0;
});

const dot = (member) => page.locator(`#levers svg.fig [role=slider][id^="levers-speed-"][data-member="${member}"]`).first();

async function gear(name) {
  await page.click(`[data-gear="${name}"]`);
  await shown(page);
}

test("a gear by keys", async () => {
  await page.locator('[role=radio][data-gear][tabindex="0"]').focus();
  const before = (await state(page)).point.state;
  await page.keyboard.press("ArrowRight");
  await shown(page);
  const now = await state(page);
  assert.notEqual(now.point.state, before);
  assert.equal(await page.locator(`[data-gear="${now.point.state}"]`).getAttribute("aria-checked"), "true");
  assert.equal(await page.evaluate(() => document.activeElement.dataset.gear), now.point.state);
  await page.keyboard.press("ArrowLeft");
  assert.equal((await state(page)).point.state, before);
  // Without the focus in the gears.
  await page.evaluate(() => document.activeElement.blur());
  await page.keyboard.press("5");
  assert.equal((await state(page)).point.state, "5");
  await page.keyboard.press("]");
  assert.equal((await state(page)).point.state, "6");
  assert.deepEqual(page.faults, []);
});

test("a dot is dragged, all others follow, and the drag is one step", async () => {
  await gear("3");
  const start = await state(page);
  const place = await dot("s12").boundingBox();
  const [x, y] = [place.x + place.width / 2, place.y + place.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let k = 1; k <= 10; k++) await page.mouse.move(x - 3 * k, y);
  await page.mouse.up();
  await shown(page);
  const now = await state(page);
  const speed = (s, m) => s.analysis.operations[0].speeds_rad_s[m];
  assert.notEqual(speed(now, "s12"), speed(start, "s12"));
  const factor = speed(now, "s12") / speed(start, "s12");
  for (const m of Object.keys(start.analysis.operations[0].speeds_rad_s)) {
    const wanted = speed(start, m) * factor;
    assert.ok(Math.abs(speed(now, m) - wanted) <= 1e-9 * (1 + Math.abs(wanted)), m);
  }
  const there = await command_line(page);
  for (const [m, value] of await dots(page)) if (m in there.operations[0].speeds_rad_s) assert.equal(value, there.operations[0].speeds_rad_s[m], m);
  await page.click("#undo");
  await shown(page);
  assert.deepEqual((await state(page)).point, start.point);
  await page.click("#redo");
  await shown(page);
  assert.deepEqual((await state(page)).point, now.point);
  assert.deepEqual(page.faults, []);
});

test("Escape takes a drag back", async () => {
  await gear("3");
  const start = await state(page);
  const place = await dot("s12").boundingBox();
  const [x, y] = [place.x + place.width / 2, place.y + place.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x - 40, y);
  await shown(page);
  assert.notDeepEqual((await state(page)).point, start.point);
  await page.keyboard.press("Escape");
  await page.mouse.move(x - 60, y);
  await page.mouse.up();
  await shown(page);
  assert.deepEqual((await state(page)).point, start.point);
});

test("a dot by keys, and what it says", async () => {
  await gear("3");
  await dot("s12").focus();
  const value = async () => (await state(page)).analysis.operations[0].speeds_rad_s.s12;
  const start = await value();
  await page.keyboard.press("ArrowRight");
  await shown(page);
  const one = (await value()) - start;
  assert.ok(one > 0);
  await page.keyboard.press("PageUp");
  await shown(page);
  assert.ok((await value()) - start > 5 * one);
  const high = await value();
  await page.keyboard.press("PageDown");
  await page.keyboard.press("ArrowLeft");
  await shown(page);
  assert.ok((await value()) < high - 5 * one);
  assert.match(await dot("s12").getAttribute("aria-valuetext"), /^s12 .*rpm/);
  // The live region waits until the handle rests.
  await page.waitForFunction(() => /s12/.test(document.getElementById("live").textContent), null, { timeout: 5_000 });
  for (const name of ["aria-label", "aria-valuenow"]) assert.ok(await dot("s12").getAttribute(name), name);
});

test("a clutch opens and closes: freedoms come and go", async () => {
  await gear("3");
  const closed = await page.evaluate(() => window.__studio.engaged);
  const button = page.locator(`#train [data-element="${closed[0]}"][role=button]`).first();
  assert.equal(await button.getAttribute("aria-pressed"), "true");
  await button.click();
  await shown(page);
  const free = await state(page);
  assert.deepEqual(free.point.engaged, closed.filter((e) => e !== closed[0]));
  assert.equal(free.analysis?.operations[0]?.degrees_of_freedom, 2, JSON.stringify(free.refused));
  // Two speeds for two freedoms.
  assert.equal(Object.keys(free.point.speeds).length, 2);
  await button.focus();
  await page.keyboard.press("Space");
  await shown(page);
  assert.equal((await state(page)).point.state, "3");
  assert.deepEqual(page.faults, []);
});

test("with two freedoms a second dot is dragged and the first stays", async () => {
  await gear("3");
  const first = await page.evaluate(() => window.__studio.engaged[0]);
  await page.locator(`#train [data-element="${first}"][role=button]`).first().click();
  await shown(page);
  const before = await state(page);
  const [kept, moved] = Object.keys(before.point.speeds);
  const own = await dot(moved).count() ? moved : kept;
  const other = own === moved ? kept : moved;
  await dot(own).focus();
  await page.keyboard.press("ArrowRight");
  await shown(page);
  const now = await state(page);
  const speed = (s, m) => s.analysis.operations[0].speeds_rad_s[m];
  assert.notEqual(speed(now, own), speed(before, own));
  assert.ok(Math.abs(speed(now, other) - speed(before, other)) < 1e-9);
});

test("a number is typed with its unit", async () => {
  await gear("4");
  for (const [typed, speed] of [["1450 rpm", (1450 * Math.PI) / 30], ["25 rad/s", 25], ["900", (900 * Math.PI) / 30]]) {
    await page.focus("#speed");
    await page.keyboard.press("Enter");
    await page.keyboard.type(typed);
    await page.keyboard.press("Enter");
    await shown(page);
    const now = await state(page);
    assert.ok(Math.abs(now.analysis.operations[0].speeds_rad_s.input - speed) < 1e-9, typed);
  }
});

test("pin compares, a second press releases", async () => {
  await gear("3");
  await page.click("#pin");
  assert.equal(await page.locator("#pin").getAttribute("aria-pressed"), "true");
  await gear("4");
  assert.match(await page.locator("#efficiency").innerText(), /[+\u2212-].*against/);
  await page.click("#pin");
  assert.equal(await page.locator("#pin").getAttribute("aria-pressed"), "false");
});

test("the theme changes the colours of the page", async () => {
  const ground = () => page.evaluate(() => getComputedStyle(document.querySelector("#train")).backgroundColor);
  const light = await ground();
  await page.click("#theme");
  assert.notEqual(await ground(), light);
  await page.click("#theme");
  assert.equal(await ground(), light);
});

test("every tab of the drawer opens and shows something", { timeout: 180_000 }, async () => {
  const tabs = await page.$$eval("[role=tab]", (all) => all.map((t) => t.textContent.trim()));
  assert.ok(tabs.length >= 6, tabs.join(", "));
  for (const name of tabs) {
    await page.locator("[role=tab]", { hasText: name }).first().click();
    await page.waitForFunction(() => [...document.querySelectorAll("[role=tabpanel]")].some((p) => p.getClientRects().length > 0 && p.textContent.trim().length > 20), null, {
      timeout: 30_000,
    });
  }
  await page.keyboard.press("Escape");
  assert.deepEqual(page.faults, []);
});

test("an edit of the text that is wrong keeps the last good train", async () => {
  const start = await state(page);
  await page.evaluate(() => window.__studio.type(window.__studio.doc.text.replace("members", "membrs")));
  await page.waitForSelector("[role=alert]");
  assert.match(await page.locator("[role=alert]").first().innerText(), /line \d+: .*members/);
  assert.ok((await dots(page)).length > 5);
  await page.evaluate(() => window.__studio.undo());
  await shown(page);
  assert.equal((await state(page)).doc.text, start.doc.text);
  assert.equal(await page.locator("[role=alert]").count(), 0);
});
