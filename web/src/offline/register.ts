/** Keeps the page's files in the browser, so that the page opens while the server is away. */

/** After the first picture: the files are loaded a second time. */
const AFTER_MS = 3000;

export function keepForOffline(): void {
  // Browsers offer service workers on this machine and over TLS only.
  if (!import.meta.env.PROD || !("serviceWorker" in navigator)) return;
  setTimeout(() => {
    // Private windows may refuse; the page then needs the server to open.
    navigator.serviceWorker.register("./sw.js").catch((reason: unknown) => console.info("not kept for offline use:", reason));
  }, AFTER_MS);
}
