/**
 * Service worker: the page opens without its server, from the files of the last visit, and then
 * shows that it is not connected. With the server, every file comes from the server.
 */

/** Files of this build, and their hash: written before this script by `vite.config.ts`. */
declare const PAGE_FILES: readonly string[];
declare const PAGE_VERSION: string;

/** The types of service workers are not in the library of pages. */
interface WorkerEvent extends Event {
  waitUntil(work: Promise<unknown>): void;
}
interface RequestEvent extends WorkerEvent {
  readonly request: Request;
  respondWith(response: Promise<Response>): void;
}
interface WorkerScope {
  readonly registration: { readonly scope: string };
  readonly clients: { claim(): Promise<void> };
  skipWaiting(): Promise<void>;
  addEventListener(type: "install" | "activate", listener: (event: WorkerEvent) => void): void;
  addEventListener(type: "fetch", listener: (event: RequestEvent) => void): void;
}

const worker = globalThis as unknown as WorkerScope;
const PREFIX = "navette-page-";
const CACHE = `${PREFIX}${PAGE_VERSION}`;
/** A server that does not answer for so long is away. */
const PATIENCE_MS = 4000;
/** Large, and loaded on request: stored when it is first used. */
const ON_REQUEST = /three_renderer/;

const addressOf = (file: string): string => new URL(file, worker.registration.scope).href;
const KNOWN = new Set(PAGE_FILES.map(addressOf));

worker.addEventListener("install", (event) => event.waitUntil(install()));
worker.addEventListener("activate", (event) => event.waitUntil(activate()));
worker.addEventListener("fetch", (event) => {
  const address = fileOf(event.request);
  if (address !== null) event.respondWith(answer(address));
});

async function install(): Promise<void> {
  const cache = await caches.open(CACHE);
  await cache.addAll(PAGE_FILES.filter((file) => !ON_REQUEST.test(file)).map(addressOf));
  await worker.skipWaiting();
}

async function activate(): Promise<void> {
  const old = (await caches.keys()).filter((name) => name.startsWith(PREFIX) && name !== CACHE);
  await Promise.all(old.map((name) => caches.delete(name)));
  await worker.clients.claim();
}

/** The file of the page that a request is for; null for everything else. */
function fileOf({ method, mode, url }: Request): string | null {
  const { origin, pathname } = new URL(url);
  const path = origin + pathname;
  if (method !== "GET") return null;
  if (mode === "navigate") return path === worker.registration.scope ? addressOf("index.html") : null;
  return KNOWN.has(path) ? path : null;
}

async function answer(address: string): Promise<Response> {
  const cache = await caches.open(CACHE);
  const stored = await cache.match(address);
  let response: Response;
  try {
    response = await fetch(address, stored ? { signal: AbortSignal.timeout(PATIENCE_MS) } : {});
  } catch (error) {
    if (stored) return stored;
    throw error;
  }
  if (!stored && response.ok) await cache.put(address, response.clone());
  return response;
}
