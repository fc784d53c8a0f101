/** The compiled library, unpacked from the page: no request is made for it. Only the page has it; workers are given it. */

import unpacker from "../wasm/willis_unpack_bg.wasm.gz?inline";
import { initSync, unpack } from "../wasm/willis_unpack.js";
import packed from "../wasm/willis_web_bg.wasm.lzma?inline";

let compiled: Promise<WebAssembly.Module> | null = null;

function bytes(url: string): Uint8Array<ArrayBuffer> {
  return Uint8Array.from(atob(url.slice(url.indexOf(",") + 1)), (c) => c.charCodeAt(0));
}

export function module(): Promise<WebAssembly.Module> {
  // Browsers unpack gzip by themselves; what they unpack so unpacks the library, which is a third smaller with LZMA.
  compiled ??= (async () => {
    const stream = new Blob([bytes(unpacker)]).stream().pipeThrough(new DecompressionStream("gzip"));
    initSync({ module: await WebAssembly.compile(await new Response(stream).arrayBuffer()) });
    return WebAssembly.compile(unpack(bytes(packed)) as Uint8Array<ArrayBuffer>);
  })();
  return compiled;
}
