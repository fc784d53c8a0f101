/** The compiled library, unpacked from the page: no request is made for it. Only the page has it; workers are given it. */

import packed from "../wasm/willis_web_bg.wasm.gz?inline";

let compiled: Promise<WebAssembly.Module> | null = null;

export function module(): Promise<WebAssembly.Module> {
  compiled ??= (async () => {
    const text = atob(packed.slice(packed.indexOf(",") + 1));
    const bytes = Uint8Array.from(text, (c) => c.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
    return WebAssembly.compile(await new Response(stream).arrayBuffer());
  })();
  return compiled;
}
