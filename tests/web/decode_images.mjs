// Decodes image files as the page does: a hash of the pixels, or the problem, of each.
import { readFile } from "node:fs/promises";
import { answer, importOf, sha } from "./jobs.mjs";

const { decodeImage } = await importOf("images.js");
await answer(async (file) => {
  const { width, height, pixels } = await decodeImage(new Uint8Array(await readFile(file)), "image");
  return { size: [width, height], sha: sha(pixels) };
});
