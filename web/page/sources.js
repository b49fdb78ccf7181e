// What the page builds memories of: files that were dropped or chosen, and examples.

/** @import { Site } from "./app.js" @import { DroppedFile } from "./folder.js" */

/** @typedef {{ files: DroppedFile[], example: string | null }} Source */

/** @param {File[]} list */ export async function sourceOfFiles(list) {
  const files = list.map(async (file) => ({ name: file.name, bytes: new Uint8Array(await file.arrayBuffer()) }));
  return { files: await Promise.all(files), example: null };
}

/** @param {string} example @param {Site} site */ export async function sourceOfExample(example, { examples }) {
  const files = examples[example].files.map(async (name) => {
    const answer = await fetch(`examples/${name}`);
    if (!answer.ok) throw new Error(`examples/${name}: ${answer.status}`);
    return { name, bytes: new Uint8Array(await answer.arrayBuffer()) };
  });
  return { files: await Promise.all(files), example };
}
