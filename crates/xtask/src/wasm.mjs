// Runs a program of WebAssembly with the standard input and output of this one.
import { readFile } from "node:fs/promises";
import { WASI } from "node:wasi";

const wasi = new WASI({ version: "preview1" });
const program = await WebAssembly.compile(await readFile(process.argv.at(-1)));
process.exitCode = wasi.start(await WebAssembly.instantiate(program, wasi.getImportObject()));
