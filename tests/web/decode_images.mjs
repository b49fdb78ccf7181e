// Decodes image files as the page does: {site, files} in, a hash of the pixels or the problem of each out.
import { createHash } from "node:crypto";
import { readFile } from "node:fs/promises";
import { pathToFileURL } from "node:url";

const { site, files } = JSON.parse(await new Response(process.stdin).text());
const { decodeImage } = await import(pathToFileURL(`${site}/images.js`).href);
const results = [];
for (const file of files) {
  try {
    const { width, height, pixels } = await decodeImage(new Uint8Array(await readFile(file)), "image");
    results.push({ size: [width, height], sha: createHash("sha256").update(pixels).digest("hex") });
  } catch (error) {
    results.push({ problem: error.message });
  }
}
console.log(JSON.stringify(results));
