import { defineConfig } from "vitest/config";

// The files are the same wherever they are built: names carry a hash of the content only.
export default defineConfig({
  base: "./",
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
