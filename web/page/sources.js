// What the page builds memories of: files that were dropped or chosen, examples, and what a link names.

import { boundedBytes } from "./bounded.js";
import { nameOf } from "./folder.js";
import { LONGEST_UNPACKED, readLink } from "./links.js";
/** @import { Site } from "./app.js" @import { DroppedFile } from "./folder.js" */

/** `example`: its name; `urls`: where the files are, in order. @typedef {{ files: DroppedFile[], example: string |
 * null, urls?: string[] }} Source */

const MOST = 256 * 2 ** 20; // bytes that are fetched for a link

/** @param {File[]} list */ export async function sourceOfFiles(list) {
  const files = list.map(async (file) => ({ name: file.name, bytes: new Uint8Array(await file.arrayBuffer()) }));
  return { files: await Promise.all(files), example: null };
}

/** @param {string} example @param {Site} site @param {AbortSignal} signal */
export async function sourceOfExample(example, { examples }, signal) {
  const files = examples[example].files.map(async (name) => {
    const answer = await fetch(`examples/${name}`, { signal });
    if (!answer.ok) throw new Error(`examples/${name}: ${answer.status}`);
    return { name, bytes: new Uint8Array(await answer.arrayBuffer()) };
  });
  return { files: await Promise.all(files), example };
}

/** The source and the options of an address; the courtyard where it names nothing. Throws an error for a link that
 * cannot be honoured. @param {Location} address @param {Site} site @param {(text: string) => void} onStage @param
 * {AbortSignal} signal */
export async function sourceOfAddress({ hash, search }, site, onStage, signal) {
  const { scene, memory, ...options } = readLink(hash);
  const urls = new URLSearchParams(search).getAll("model");
  if ([scene, memory, urls[0]].filter(Boolean).length > 1) throw new Error("it names several scenes");
  if (urls.length) return { source: await sourceOfUrls(urls, onStage, signal), ...options };
  if (memory) {
    const { unpack } = await import("./packed.js");
    return { source: { files: await unpack(memory, LONGEST_UNPACKED), example: null }, ...options };
  }
  if (!scene && hash.length > 1)
    throw new Error("it names no scene: it was copied from a model that never left its owner's computer");
  const example = scene ?? "courtyard";
  if (!Object.hasOwn(site.examples, example)) throw new Error(`there is no example ${JSON.stringify(example)} here`);
  return { source: await sourceOfExample(example, site, signal), ...options };
}

/** @param {string[]} urls @param {(text: string) => void} onStage @param {AbortSignal} signal */
async function sourceOfUrls(urls, onStage, signal) {
  /** @type {DroppedFile[]} */ const files = [];
  let left = MOST;
  for (const url of urls) {
    onStage(url);
    const bytes = await fetched(url, left, signal);
    left -= bytes.length;
    files.push({ name: nameOf(new URL(url, location.href)), bytes });
  }
  return { files, example: null, urls };
}

/** @param {string} url @param {number} most bytes @param {AbortSignal} signal */
async function fetched(url, most, signal) {
  const answer = await fetch(url, { credentials: "omit", signal }).catch(() => {
    throw new Error(`${url}: nothing came; its server must answer, and allow other pages to read it (CORS)`);
  });
  if (!answer.ok || !answer.body) throw new Error(`${url}: the server answers ${answer.status}`);
  const bytes = await boundedBytes(answer.body, most);
  if (!bytes) throw new Error(`${url}: has more than ${MOST / 2 ** 20} MiB; download it, and drop it on this page`);
  return bytes;
}
