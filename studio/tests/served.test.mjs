// The page as `willis studio` serves it.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { browser, dots, file, page_file, state, studio, willis } from "./studio.mjs";

let at, server, url, folder;
const text = "# a remark </script><b>\n" + file("examples/zf-8hp70.toml");
before(async () => {
  at = await browser();
  folder = mkdtempSync(join(tmpdir(), "studio-"));
  writeFileSync(join(folder, "own.toml"), text);
  server = spawn(willis, ["studio", join(folder, "own.toml"), "--page", page_file], { stdio: ["ignore", "pipe", "inherit"] });
  url = await new Promise((done, fail) => {
    server.stdout.once("data", (line) => done(String(line).trim()));
    server.once("exit", (code) => fail(new Error(`willis studio ended: ${code}`)));
  });
});
after(async () => {
  await at?.close();
  server?.kill("SIGINT");
  rmSync(folder, { recursive: true });
});

test("the file of the command line is shown, and only its server is asked", { timeout: 60_000 }, async () => {
  const page = await studio(at, { url });
  const held = await state(page);
  assert.deepEqual([held.doc.name, held.doc.text], ["own.toml", text]);
  assert.ok(held.analysis);
  assert.ok((await dots(page)).length > 5);
  const foreign = page.requests.filter((r) => !r.startsWith(url) && !/^(blob|data):/.test(r));
  assert.deepEqual(foreign, []);
  const tried = await page.evaluate(() => fetch("http://127.0.0.1:9/").then(() => "answered", (e) => String(e)));
  assert.match(tried, /TypeError/);
  await page.context().close();
});

test("the page may read and write the file, over what it has seen alone", { timeout: 60_000 }, async () => {
  const page = await studio(at, { url });
  const put = (tag, body) => page.evaluate(async ([tag, body]) => (await fetch("file", { method: "PUT", headers: { "If-Match": tag }, body })).status, [tag, body]);
  const { tag, own } = await page.evaluate(async () => {
    const reply = await fetch("file");
    return { tag: reply.headers.get("ETag"), own: await reply.text() };
  });
  assert.equal(own, text);
  assert.equal(await put('"stale"', "x"), 412);
  assert.equal(await put(tag, text + "# more\n"), 204);
  assert.equal(readFileSync(join(folder, "own.toml"), "utf8"), text + "# more\n");
  assert.equal(await put(tag, "x"), 412);
  await page.context().close();
});

test("page and file follow each other", { timeout: 60_000 }, async () => {
  const page = await studio(at, { url });
  const before = readFileSync(join(folder, "own.toml"), "utf8");
  writeFileSync(join(folder, "own.toml"), before + "# by an editor\n");
  await page.waitForFunction(() => window.__studio.doc.text.includes("# by an editor"), null, { timeout: 55_000 });
  await page.evaluate(() => window.__studio.type(window.__studio.doc.text + "# by the page\n"));
  const read = () => readFileSync(join(folder, "own.toml"), "utf8");
  for (let k = 0; k < 100 && !read().includes("# by the page"); k++) await new Promise((done) => setTimeout(done, 100));
  assert.ok(read().endsWith("# by an editor\n# by the page\n"));
  await page.context().close();
});
