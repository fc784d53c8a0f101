// Chores of the studio's build: `pack FOLDER` packs what unpacks the library; `answers FOLDER WILLIS` asks for the analysis of every
// example, there and of the program: the two must agree to the last byte, or, where laws of loss take powers and exponentials,
// which every platform has from another library, to 1e-12.
import { execFileSync } from "node:child_process";
import { readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { gunzipSync, gzipSync } from "node:zlib";

const [chore, folder, willis] = process.argv.slice(-(process.argv.includes("answers") ? 3 : 2));
const unpacker = join(folder, "willis_unpack_bg.wasm.gz");

if (chore === "pack") {
  const plain = join(folder, "willis_unpack_bg.wasm");
  writeFileSync(unpacker, gzipSync(readFileSync(plain), { level: 9 }));
  // Nothing else reads it, and a bundler would take it for a file of the page.
  rmSync(plain);
} else {
  const { initSync, Session } = await import(pathToFileURL(join(folder, "willis_web.js")).href);
  const unpacking = await import(pathToFileURL(join(folder, "willis_unpack.js")).href);
  unpacking.initSync({ module: gunzipSync(readFileSync(unpacker)) });
  globalThis.willisProgress = () => {};
  initSync({ module: unpacking.unpack(readFileSync(join(folder, "willis_web_bg.wasm.lzma"))) });
  const names = readdirSync("examples");
  const text = (name) => readFileSync(join("examples", name), "utf8");
  const tables = Object.fromEntries(names.filter((n) => n.endsWith(".csv")).map((n) => [n, text(n)]));
  const trains = names.filter((n) => n.endsWith(".toml"));
  const NUMBER = /-?\d+(?:\.\d+)?(?:e[-+]?\d+)?/gi;
  const near = (a, b) => Math.abs(a - b) <= 1e-12 * Math.max(Math.abs(a), Math.abs(b), 1);
  // How fast an iteration converged is the quotient of two differences that are nothing but round-off.
  const CONVERGENCE = /"convergence": \{[^}]*\}/g;
  // Residuals, W, are the round-off of powers that may be a million times larger.
  const RESIDUAL = /("\w*residual_w": )([^,\n}]*)/g;
  const alike = (...both) => {
    const [here, there] = both.map((t) => t.replace(CONVERGENCE, ""));
    const left = [here, there].map((t) => [...t.matchAll(RESIDUAL)].map((m) => Number(m[2])));
    const [ours, theirs] = [here, there].map((t) => [...t.replace(RESIDUAL, "$1").matchAll(NUMBER)].map((m) => Number(m[0])));
    const same = here.replace(NUMBER, "#") === there.replace(NUMBER, "#");
    return same && ours.every((x, k) => near(x, theirs[k])) && left[0].every((x, k) => Math.abs(x - left[1][k]) <= 1e-6);
  };
  let same = 0;
  for (const name of trains) {
    const file = `examples/${name}`;
    const here = execFileSync(willis, ["analyze", file, "--format", "json"], { encoding: "utf8", maxBuffer: 1 << 28 });
    const session = new Session(file, text(name), JSON.stringify(tables));
    const there = session.ask("analyze", "{}", "{}");
    session.free();
    same += here === there;
    if (here !== there && !alike(here, there)) {
      console.error(`${file}: WebAssembly gives another answer`);
      process.exit(1);
    }
  }
  console.log(`${trains.length} examples: ${same} have the same bytes as WebAssembly, the others the same to 1e-12`);
}
