// Heat and losses of a train in the drawer: temperatures, the warm-up that is read by hand, and tests that are dropped on it.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { browser, file, open, root, state, studio, willis } from "./studio.mjs";

let at;
before(async () => {
  at = await browser();
});
after(() => at?.close());

const PATIENT = { timeout: 60_000 };
const tab = (page, name) => page.click(`[role="tab"]:text-is("${name}")`);
const told = (...words) => JSON.parse(execFileSync(willis, [...words, "--format", "json"], { encoding: "utf8", cwd: root, maxBuffer: 1 << 28 }));
const box = (page, name) => page.locator(`.warmth .sheet [data-quantity="temperature ${name}"] text:nth-of-type(2)`).textContent().then((t) => t.trim());
const slider = (page) => page.locator('[role="slider"][aria-label="Time of the warm-up"]');
const degrees = (k) => `${(k - 273.15).toFixed(1)} °C`;

/** Lets a file fall on the drawer, as from a folder. */
async function drop(page, name, text) {
  const files = await page.evaluateHandle(([name, text]) => {
    const all = new DataTransfer();
    all.items.add(new File([text], name, { type: "text/csv" }));
    return all;
  }, [name, text]);
  await page.dispatchEvent(".heat", "drop", { dataTransfer: files });
}

test("temperatures are those of the command line, and the warm-up is read with keys and by hand", { timeout: 120_000 }, async () => {
  const page = await studio(at);
  await open(page, "industrial-planetary-heat.toml");
  await tab(page, "Heat");
  await slider(page).waitFor(PATIENT);
  const heat = told("heat", "examples/industrial-planetary-heat.toml", "--operation", "rated").operations[0];
  const { places, rows } = heat.warm_up;
  for (const [name, place] of Object.entries(heat.heat.places)) assert.equal(await box(page, name), degrees(place.temperature_k));
  assert.match(await page.locator(".warmth aside .big").innerText(), /^380\.4 kW$/);

  await slider(page).focus();
  await page.keyboard.press("Home");
  assert.equal(await box(page, "oil"), degrees(rows[0].temperatures_k[0]));
  await page.keyboard.press("PageUp");
  await page.keyboard.press("ArrowRight");
  const sun = places.indexOf("sun gear");
  assert.equal(await box(page, "sun gear"), degrees(rows[11].temperatures_k[sun]));
  assert.ok((await slider(page).getAttribute("aria-valuetext")).includes(`sun gear ${degrees(rows[11].temperatures_k[sun])}`));
  await page.keyboard.press("End");
  assert.equal(await box(page, "oil"), degrees(rows.at(-1).temperatures_k[0]));
  // Out again: the steady state.
  await page.keyboard.press("Escape");
  assert.equal(await box(page, "oil"), degrees(heat.heat.oil_k));
  assert.ok(await page.isVisible("#drawer-view"));

  await page.locator(".warmth .over .ground").scrollIntoViewIfNeeded();
  const ground = await page.locator(".warmth .over .ground").boundingBox();
  await page.mouse.move(ground.x + 2, ground.y + 30);
  await page.mouse.down();
  await page.mouse.move(ground.x + ground.width / 2, ground.y + 30, { steps: 4 });
  await page.mouse.up();
  const t = Number(await slider(page).getAttribute("aria-valuenow"));
  assert.ok(Math.abs(t - rows.at(-1).time_s / 2) <= rows[1].time_s, `${t} s`);
  const row = rows.find((r) => r.time_s === t);
  assert.equal(await box(page, "oil"), degrees(row.temperatures_k[0]));
  assert.deepEqual(page.faults, []);
  await page.context().close();
});

test("what the file says of the heat is a number to drag, and a step", { timeout: 120_000 }, async () => {
  const page = await studio(at);
  await open(page, "industrial-planetary-heat.toml");
  await tab(page, "Heat");
  await slider(page).waitFor(PATIENT);
  const [before, text] = [await box(page, "oil"), (await state(page)).doc.text];
  await page.locator('[aria-label="heat.ambient"]').focus();
  for (let k = 0; k < 5; k++) await page.keyboard.press("PageUp");
  await page.waitForFunction((was) => document.querySelector('.warmth .sheet [data-quantity="temperature oil"] text:nth-of-type(2)')?.textContent !== was, before, PATIENT);
  assert.notEqual((await state(page)).doc.text, text);
  for (let k = 0; k < 5; k++) await page.evaluate(() => window.__studio.undo());
  assert.equal((await state(page)).doc.text, text);
  assert.deepEqual(page.faults, []);
  await page.context().close();
});

test("without heat in the file a button begins with one", { timeout: 120_000 }, async () => {
  const page = await studio(at);
  await open(page, "fva-planetary-stage.toml");
  await tab(page, "Heat");
  await page.click("button:has-text('Begin with a housing')");
  await slider(page).waitFor(PATIENT);
  assert.match((await state(page)).doc.text, /\[heat\]\nambient/);
  await page.evaluate(() => window.__studio.undo());
  assert.doesNotMatch((await state(page)).doc.text, /\[heat\]/);
  assert.deepEqual(page.faults, []);
  await page.context().close();
});

test("tests that are dropped are fitted as by the command line, and the factors go into the file", { timeout: 120_000 }, async () => {
  const page = await studio(at);
  await open(page, "fva-planetary-stage.toml");
  await tab(page, "Heat");
  await drop(page, "monday.csv", file("examples/tests-fva-planetary-stage.csv"));
  await page.locator(".fit").waitFor(PATIENT);
  const fit = told("calibrate", "examples/fva-planetary-stage.toml", "--data", "examples/tests-fva-planetary-stage.csv");
  const rows = await page.$$eval(".fit section:first-child tbody tr", (all) => all.map((r) => [...r.cells].map((c) => c.innerText.trim())));
  assert.deepEqual(rows.map((r) => [r[0], r[1]]), fit.parts.map((p) => [p.name, p.factor.toPrecision(3)]));
  const words = await page.locator(".fit").innerText();
  assert.ok(words.includes(`${fit.learnt} of ${fit.combinations} combinations are learnt`));
  for (const b of fit.blind) assert.ok(words.includes(b.changes[0].name));
  assert.equal(await page.locator(".fit ol.next li").count(), fit.next.length);
  // The table is not one of the train's.
  assert.deepEqual(Object.keys((await state(page)).doc.files), []);
  const text = (await state(page)).doc.text;
  await page.click("button:has-text('Take the factors into the file')");
  assert.equal((await state(page)).broken, null);
  assert.match((await state(page)).doc.text, /calibrated/);
  await page.evaluate(() => window.__studio.undo());
  assert.equal((await state(page)).doc.text, text);
  // What is no table of tests is refused in words.
  await drop(page, "broken.csv", "a,b\n1,2\n");
  await page.waitForFunction(() => !document.querySelector(".fit") && document.querySelector(".heat .sentence")?.textContent.trim(), null, PATIENT);
  assert.deepEqual(page.faults, []);
  await page.context().close();
});

for (const theme of ["light", "dark"]) {
  test(`on a phone the heat fits, and axe finds nothing serious, ${theme}`, { timeout: 120_000 }, async () => {
    const page = await studio(at, { width: 375, height: 740, hasTouch: true, isMobile: true, colorScheme: theme });
    await open(page, "fva-planetary-stage.toml");
    await page.click('.ptabs button:has-text("More")');
    await tab(page, "Heat");
    await page.click("button:has-text('Begin with a housing')");
    await slider(page).waitFor(PATIENT);
    await page.evaluate(file("studio/node_modules/axe-core/axe.min.js"));
    const look = async (what) => {
      const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
      assert.ok(wide <= 0, `${what}: ${wide} px too wide`);
      const found = await page.evaluate(() => axe.run(document, { resultTypes: ["violations"] }));
      const serious = found.violations.filter((v) => ["serious", "critical"].includes(v.impact));
      assert.deepEqual(serious.map((v) => `${v.id}: ${v.nodes[0].html.slice(0, 200)}`), [], what);
    };
    await look("temperatures");
    await page.click("button:has-text('Tests of this example')");
    await page.locator(".fit").waitFor(PATIENT);
    await look("tests");
    assert.deepEqual(page.faults, []);
    await page.context().close();
  });
}

test("losses over torque and oil temperature, film and friction along the teeth", { timeout: 120_000 }, async () => {
  const page = await studio(at);
  await open(page, "fva-planetary-stage.toml");
  await tab(page, "Losses");
  const view = page.locator("#drawer-view");
  const says = (words) => page.waitForFunction((w) => document.querySelector("#drawer-view .sheet svg")?.textContent.includes(w), words, PATIENT);
  await says("speed of sun varies");
  await view.locator("[role=radio]:text-is('speed')").focus();
  await page.keyboard.press("ArrowRight");
  await says("torque of sun varies");
  await page.keyboard.press("ArrowRight");
  await says("oil temperature varies");
  await page.keyboard.press("ArrowRight");
  await says("film thickness over composite roughness");
  await view.locator("select").selectOption("P1.planet-ring");
  await says("mixed");
  await page.keyboard.press("Escape");
  assert.deepEqual(page.faults, []);
  await page.context().close();
});
