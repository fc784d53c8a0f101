import { svelte } from "@sveltejs/vite-plugin-svelte";
import { defineConfig } from "vite";
import { viteSingleFile } from "vite-plugin-singlefile";

// One page without a server: scripts, styles and the WebAssembly are within it.
export default defineConfig({
  plugins: [svelte(), viteSingleFile()],
  assetsInclude: ["**/*.gz", "**/*.lzma"],
  worker: { format: "iife" },
  build: { target: "es2022", assetsInlineLimit: 100_000_000, cssCodeSplit: false, chunkSizeWarningLimit: 10_000 },
});
