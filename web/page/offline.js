// The service worker: after its first visit the page opens without a network. The network comes first, so that nobody
// sees an old page. Circuits and designs of boards are kept once they were loaded.

import { files, version } from "./offline_files.js";

/** @typedef {Event & { waitUntil: (work: Promise<unknown>) => void }} LongEvent */
/** @typedef {Event & { request: Request, respondWith: (answer: Promise<Response>) => void }} FetchEvent */

const CACHE = `voxrt ${version}`;

/** @param {string} type @param {() => Promise<unknown>} work */
const during = (type, work) =>
  self.addEventListener(type, (event) => /** @type {LongEvent} */ (event).waitUntil(work()));

during("install", async () => (await caches.open(CACHE)).addAll(files));

during("activate", async () => {
  const old = (await caches.keys()).filter((name) => name.startsWith("voxrt ") && name !== CACHE);
  await Promise.all(old.map((name) => caches.delete(name)));
});

self.addEventListener("fetch", (event) => {
  const fetched = /** @type {FetchEvent} */ (event);
  const { method, url } = fetched.request;
  if (method === "GET" && new URL(url).origin === location.origin) fetched.respondWith(answerOf(fetched.request));
});

/** @param {Request} request */ async function answerOf(request) {
  try {
    const answer = await fetch(request);
    if (answer.ok) await (await caches.open(CACHE)).put(request, answer.clone());
    return answer;
  } catch (error) {
    const kept = await caches.match(request, { ignoreSearch: request.mode === "navigate" });
    if (kept) return kept;
    throw error;
  }
}
