import { createHash } from "node:crypto";
import { readdirSync, readFileSync } from "node:fs";
import type { Plugin } from "vite";
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

const WORKER = "sw.js";

/** The service worker begins with the names of all files and their hash: it changes with each of them. */
const listFiles: Plugin = {
  name: "list-files",
  apply: "build",
  generateBundle: {
    order: "post",
    handler(_options, bundle) {
      const files = new Map<string, string | Uint8Array>();
      for (const file of Object.values(bundle)) files.set(file.fileName, file.type === "chunk" ? file.code : file.source);
      for (const name of readdirSync("public")) files.set(name, readFileSync(`public/${name}`));
      const names = [...files.keys()].sort();
      const hash = createHash("sha256");
      for (const name of names) hash.update(name).update(files.get(name)!);
      const worker = bundle[WORKER];
      if (worker?.type !== "chunk") throw new Error(`the build has no ${WORKER}`);
      const listed = JSON.stringify(names.filter((name) => name !== WORKER));
      worker.code = `const PAGE_FILES=${listed},PAGE_VERSION="${hash.digest("hex").slice(0, 16)}";\n${worker.code}`;
    },
  },
};

// The files are the same wherever they are built: names carry a hash of the content only.
export default defineConfig({
  base: "./",
  plugins: [preloadDocking, listFiles],
  build: {
    outDir: "../src/navette/viewer/page",
    emptyOutDir: true,
    target: "es2022",
    assetsInlineLimit: 0, // the content security policy permits files, no data
    modulePreload: { polyfill: false },
    reportCompressedSize: false,
    rolldownOptions: {
      input: { index: "index.html", sw: "src/offline/worker.ts" },
      output: {
        entryFileNames: ({ name }) => (name === "sw" ? WORKER : "assets/[name].js"),
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
