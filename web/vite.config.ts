import { defineConfig } from "vitest/config";

/** Docking is loaded by large screens only; they begin with it before the first script has run. */
const LARGE = "(min-width: 44rem) and (min-height: 30.01rem)";
const preloadDocking = {
  name: "preload-docking",
  apply: "build" as const,
  transformIndexHtml: () => [
    { tag: "link", attrs: { rel: "modulepreload", crossorigin: true, href: "./assets/dock.js", media: LARGE }, injectTo: "head" as const },
    { tag: "link", attrs: { rel: "preload", as: "style", crossorigin: true, href: "./assets/dock.css", media: LARGE }, injectTo: "head" as const },
  ],
};

// The files are the same wherever they are built: names carry a hash of the content only.
export default defineConfig({
  base: "./",
  plugins: [preloadDocking],
  build: {
    outDir: "../src/navette/viewer/page",
    emptyOutDir: true,
    target: "es2022",
    assetsInlineLimit: 0, // the content security policy permits files, no data
    modulePreload: { polyfill: false },
    reportCompressedSize: false,
    rolldownOptions: {
      output: {
        entryFileNames: "assets/[name].js",
        chunkFileNames: "assets/[name].js",
        assetFileNames: "assets/[name][extname]",
      },
    },
  },
  server: {
    // `npm run dev` beside a running robot: NAVETTE_PORT, 8765 by default.
    proxy: { "/health": `http://127.0.0.1:${process.env["NAVETTE_PORT"] ?? "8765"}` },
  },
  test: { environment: "happy-dom", include: ["test/**/*.test.ts"] },
});
