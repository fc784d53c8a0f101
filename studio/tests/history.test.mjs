// Undo, links and memory.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { browser, dice, open, shown, state, studio } from "./studio.mjs";

let at, page;
before(async () => {
  at = await browser();
  page = await studio(at);
});
after(() => at?.close());

async function heap(cdp) {
  for (let k = 0; k < 3; k++) await cdp.send("HeapProfiler.collectGarbage");
  return (await cdp.send("Runtime.getHeapUsage")).usedSize;
}

/** Steps at random, each of which can be taken back. */
async function walk(steps, random) {
  const numbers = Array.from({ length: 3 * steps }, random);
  return page.evaluate((numbers) => {
    const s = window.__studio;
    let made = 0;
    for (let k = 0; k + 2 < numbers.length; k += 3) {
      const [kind, a, b] = numbers.slice(k, k + 3);
      const one = (all, x) => all[Math.floor(x * all.length)];
      const before = [s.doc, s.point];
      if (kind < 0.3) s.gear(one(s.facts.states, a).name);
      else if (kind < 0.5) s.setSpeed(s.input ?? s.facts.members[0], 100 + Math.round(5000 * a));
      else if (kind < 0.65) s.setTorque(s.input ?? s.facts.members[0], 1 + Math.round(500 * a));
      else if (kind < 0.8 && s.facts.elements.length) s.toggle(one(s.facts.elements, a).name);
      else {
        const teeth = s.facts.quantities.filter((q) => q.path.endsWith("teeth") && q.value);
        const q = one(teeth, a);
        if (q) s.edit("teeth", (session) => session.set(q.path, String(Number(q.value) + (b < 0.5 ? 1 : -1))));
      }
      if (s.doc !== before[0] || s.point !== before[1]) made += 1;
    }
    return made;
  }, numbers);
}

const undo_all = () =>
  page.evaluate(() => {
    let n = 0;
    while (window.__studio.canUndo && n < 5_000) {
      window.__studio.undo();
      n += 1;
    }
    return n;
  });

test("1,000 random steps, taken back, leave everything as it was, and no memory", { timeout: 600_000 }, async () => {
  await open(page, "zf-8hp70.toml");
  const cdp = await page.context().newCDPSession(page);
  const random = dice();
  // Once around, so that everything that is made once is there.
  await walk(150, random);
  await undo_all();
  await open(page, "zf-8hp70.toml");
  await walk(20, random);
  await undo_all();
  await open(page, "zf-8hp70.toml");
  const first = await heap(cdp);
  // As many as are kept, again and again: each round is back where it began.
  for (let round = 0; round < 10; round++) {
    const start = await state(page);
    const made = await walk(100, random);
    assert.ok(made > 50, `${made} steps`);
    const steps = await page.evaluate((text) => {
      const s = window.__studio;
      let n = 0;
      while (s.canUndo && n < 199 && !(JSON.stringify([s.doc, s.point]) === text && n >= 1)) {
        s.undo();
        n += 1;
      }
      return n;
    }, JSON.stringify([start.doc, start.point]));
    assert.ok(steps > 0);
    await shown(page);
    const now = await state(page);
    assert.equal(now.doc.text, start.doc.text);
    assert.deepEqual(now.point, start.point);
    assert.deepEqual(now.analysis, start.analysis);
  }
  const last = await heap(cdp);
  console.log(`heap ${(first / 1e6).toFixed(1)} MB, after 1,000 steps ${(last / 1e6).toFixed(1)} MB`);
  assert.ok(last < 1.1 * first, `${first} to ${last} bytes`);
  assert.deepEqual(page.faults, []);
});

test("undo and redo go over the same states", async () => {
  await open(page, "zf-8hp70.toml");
  const seen = [];
  for (const gear of ["1", "3", "5", "R"]) {
    await page.evaluate((gear) => window.__studio.gear(gear), gear);
    await shown(page);
    seen.push((await state(page)).point);
  }
  for (const point of seen.slice(0, -1).reverse()) {
    await page.keyboard.press("Control+z");
    assert.deepEqual((await state(page)).point, point);
  }
  for (const point of seen.slice(1)) {
    await page.keyboard.press("Control+Shift+z");
    assert.deepEqual((await state(page)).point, point);
  }
});

test("a link gives the same text, point and answer", { timeout: 120_000 }, async () => {
  for (const edited of [false, true]) {
    await open(page, "zf-8hp70.toml");
    await page.evaluate((edited) => {
      const s = window.__studio;
      if (edited) s.edit("teeth", (session) => session.text("{}").replace("# ", "# changed: "));
      s.gear("3");
      s.setSpeed(s.input, 1450);
    }, edited);
    await shown(page);
    // The link of the round before is not taken for this one.
    const before = await page.evaluate(() => location.hash);
    await page.click("#share");
    await page.waitForFunction((before) => location.hash.startsWith("#1.") && location.hash !== before, before);
    const hash = await page.evaluate(() => location.hash);
    console.log(`a link of ${hash.length} characters`);
    const here = await state(page);
    const other = await studio(at, { hash });
    const there = await state(other);
    assert.equal(there.doc.text, here.doc.text);
    assert.deepEqual(there.point, here.point);
    assert.deepEqual(there.analysis, here.analysis);
    await other.context().close();
  }
});

test("a link with a look that cannot be opens the page all the same", async () => {
  await open(page, "two-efficiencies.toml");
  const point = (await state(page)).point;
  for (const view of [{ answer: -1, losses: 1e9 }, { answer: 1e9, losses: 0 }, { answer: "1", losses: -5 }]) {
    const hash = await page.evaluate(async ([point, view]) => {
      const held = JSON.stringify({ t: "two-efficiencies.toml", p: point, v: view, w: "0" });
      const packed = await new Response(new Blob([held]).stream().pipeThrough(new CompressionStream("deflate-raw"))).arrayBuffer();
      return "#1." + btoa(String.fromCharCode(...new Uint8Array(packed))).replace(/\+/g, "-").replace(/\//g, "_").replace(/=+$/, "");
    }, [point, view]);
    const other = await studio(at, { hash });
    assert.equal((await state(other)).analysis.operations[0].verdict, "multiple");
    assert.deepEqual(await other.evaluate(() => [window.__studio.look.answer, window.__studio.look.losses]), [0, null]);
    assert.deepEqual(other.faults, []);
    await other.context().close();
  }
});

test("a link that is damaged or of another version says so, and the page lives", async () => {
  for (const hash of ["#1.AAAA", "#1.", "#9.abc", "#<img src=x onerror=alert(1)>"]) {
    const other = await studio(at, { hash });
    assert.ok((await state(other)).analysis, hash);
    assert.match(await other.locator("#live").innerText(), /link/i, hash);
    await other.context().close();
  }
});

test("the session is there after the page was closed", async () => {
  await open(page, "zf-8hp70.toml");
  await page.evaluate(() => window.__studio.gear("6"));
  await shown(page);
  const before = await state(page);
  await page.evaluate(() => history.replaceState(null, "", location.pathname));
  await page.reload();
  await page.waitForFunction(() => window.__ready === true);
  const now = await state(page);
  assert.deepEqual([now.doc, now.point], [before.doc, before.point]);
});
