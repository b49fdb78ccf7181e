// What the scripts of this folder have in common: JSON with the folder of a site comes in, JSON goes out.
import { createHash } from "node:crypto";
import { readFile } from "node:fs/promises";
import { pathToFileURL } from "node:url";

const { site, jobs } = JSON.parse(await new Response(process.stdin).text());

export const fileOf = (path) => readFile(`${site}/${path}`);
export const importOf = (path) => import(pathToFileURL(`${site}/${path}`).href);
export const sha = (bytes) => createHash("sha256").update(bytes).digest("hex");

/** Do each job and print what came out, or the problem with what `known` says. */
export async function answer(work, known = () => ({})) {
  const results = [];
  for (const job of jobs) {
    try {
      results.push(await work(job));
    } catch ({ message }) {
      results.push({ problem: message, ...known() });
    }
  }
  console.log(JSON.stringify(results));
}
