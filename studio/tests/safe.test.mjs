// Nothing leaves the page, and nothing in a file becomes a part of it.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { browser, dots, file, open, shown, state, studio } from "./studio.mjs";

let at;
before(async () => {
  at = await browser();
});
after(() => at?.close());

const own = (url) => /^(file|blob|data|about):/.test(url);

test("no request leaves the page, and it works offline", { timeout: 120_000 }, async () => {
  const page = await studio(at, { offline: true });
  await open(page, "prius-hybrid.toml");
  for (const tab of await page.locator("[role=tab]").all()) await tab.click();
  await page.click("#share");
  await page.waitForTimeout(500);
  assert.deepEqual(page.requests.filter((url) => !own(url)), []);
  assert.ok((await dots(page)).length > 2);
  assert.deepEqual(page.faults, []);
  await page.context().close();
});

test("the policy forbids every connection", async () => {
  const page = await studio(at);
  const policy = await page.locator('meta[http-equiv="Content-Security-Policy"]').getAttribute("content");
  assert.match(policy, /default-src 'none'/);
  assert.match(policy, /connect-src 'none'/);
  const tried = await page.evaluate(() => fetch("http://127.0.0.1:9/").then(() => "answered", (e) => String(e)));
  assert.match(tried, /TypeError/);
  await page.context().close();
});

const SCRIPT = "<img src=x onerror=window.__owned=1><script>window.__owned=1</script>";

test("names of a file are never markup", { timeout: 120_000 }, async () => {
  const page = await studio(at);
  const text = file("examples/zf-8hp70.toml")
    .replace(/^name\s*=\s*".*"$/m, `name = "${SCRIPT}"`)
    .replaceAll(/"output"/g, `"${SCRIPT}"`)
    .replaceAll(/\boutput\b(?=\s*=)/g, `"${SCRIPT}"`);
  await page.evaluate((text) => window.__studio.open({ name: "<img src=x onerror=window.__owned=1>.toml", text, files: {} }), text);
  await shown(page);
  const held = await state(page);
  for (const tab of await page.locator("[role=tab]").all()) {
    await tab.click();
    await page.waitForTimeout(200);
  }
  // The error of a broken file names what is in it, too.
  await page.evaluate((script) => window.__studio.open({ name: "b.toml", text: `format = 1\n"${script}" = 1\n`, files: {} }), SCRIPT);
  await page.waitForTimeout(300);
  assert.equal(await page.evaluate(() => window.__owned), undefined);
  assert.equal(await page.locator("img[src=x]").count(), 0);
  assert.ok(held.analysis || held.refused || held.broken);
  await page.context().close();
});

/** A chain of sets, each carrier the sun of the next. */
function chain(n) {
  const members = ["in", ...Array.from({ length: n }, (_, k) => `c${k}`)];
  const set = (k) => `
[[set]]
name = "P${k}"
type = "simple"
sun = { member = "${k === 0 ? "in" : `c${k - 1}`}", teeth = 24 }
ring = { member = "frame", teeth = 72 }
carrier = "c${k}"
`;
  return `format = 1\nname = "chain"\nmembers = [${members.map((m) => `"${m}"`).join(", ")}]\nterminals = ["in", "c${n - 1}"]\n${members.slice(1).map((_, k) => set(k)).join("")}`;
}

test("large and odd files leave the page alive", { timeout: 240_000 }, async () => {
  const page = await studio(at);
  const files = {
    "400 sets": chain(400),
    "10 MB": file("examples/zf-8hp70.toml") + "# ".padEnd(10_000_000, "x"),
    "10 MB of keys": "format = 1\n" + Array.from({ length: 600_000 }, (_, k) => `k${k} = [1, 2]`).join("\n"),
    nested: `format = 1\nx = ${"[".repeat(50_000)}`,
    bytes: "\u0000\ufffd\u202e",
    empty: "",
  };
  const slow = [];
  for (const [what, text] of Object.entries(files)) {
    const began = Date.now();
    const opened = page.evaluate((text) => window.__studio.open({ name: "odd.toml", text, files: {} }), text);
    await opened;
    const took = Date.now() - began;
    const held = await state(page);
    console.log(`${what}: ${took} ms, ${held.broken?.diagnostics[0]?.message ?? held.refused?.diagnostics[0]?.message ?? "shown"}`.slice(0, 200));
    // A bound for what must end at all, on a machine that is busy.
    if (took > 100_000) slow.push(`${what}: ${took} ms without an answer to anything`);
    // Whatever became of it, the next train is there at once.
    await page.evaluate((text) => window.__studio.open({ name: "good.toml", text, files: {} }), file("examples/zf-8hp70.toml"));
    await shown(page);
    assert.ok((await state(page)).analysis, what);
    assert.ok((await dots(page)).length > 5, what);
  }
  assert.deepEqual(slow, []);
  assert.deepEqual(page.faults, []);
  await page.context().close();
});
