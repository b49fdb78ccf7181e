// "Copy link", and "Save as one page": a file with the memory and all that shows it, which opens without a server.

import { cameraText } from "./camera_text.js";
import { copyAddress, sayBriefly } from "./copy_address.js";
import { manifestOf } from "./downloads.js";
import { $ } from "./elements.js";
import { LONGEST, linkOf } from "./links.js";
import { notice } from "./notices.js";
import { save } from "./save.js";
/** @import { App } from "./app.js" @import { Shown } from "./memory.js" */

/** @param {Shown} memory */
const packedText = async (memory) => (await import("./packed.js")).pack(manifestOf(memory), memory.words);

/** @param {string} script */ async function fetched(script) {
  const answer = await fetch(script);
  if (!answer.ok) throw new Error(`${script}: the server answers ${answer.status}`);
  return answer.text();
}

const WORDS = 8 * LONGEST; // more never fit

export class Sharing {
  /** @type {{ memory: Shown, packed: string | null } | null} */ #packed = null;

  /** @param {App} app */ constructor(app) {
    this.app = app;
    $("copy").onclick = () => this.#copy();
    $("save-page").onclick = () =>
      this.#savePage().catch(({ message }) => notice("error", "The page cannot be saved", message));
  }

  /** Whether an address alone brings the scene. */
  #isPublic = () => Boolean(this.app.source?.example || this.app.source?.urls) && !this.app.memory()?.edited;

  /** Show whether a link can carry the memory. @param {Shown} memory */ async show(memory) {
    $("share-says").textContent = "";
    if (this.#isPublic()) return;
    const size = (await this.#pack(memory))?.length ?? Infinity;
    if (this.app.memory() !== memory || size <= LONGEST) return;
    $("share-says").textContent = "This memory is too large for a link: save it as one page, which anyone can open.";
  }

  /** @param {Shown} memory */ async #pack(memory) {
    if (this.#packed?.memory !== memory) {
      const packed = memory.words.length > WORDS ? null : await packedText(memory);
      this.#packed = { memory, packed };
    }
    return this.#packed.packed;
  }

  async #copy() {
    const [memory, view, source] = [await this.app.settled(), this.app.view(), this.app.source];
    if (!memory || !view) return;
    const search =
      source?.urls && this.#isPublic() ? `?${new URLSearchParams(source.urls.map((url) => ["model", url]))}` : "";
    const { budget, ...options } = this.app.panel.options();
    const built = memory.fixed ? {} : { ...options, depth: memory.depth, words: budget };
    const packed = this.#isPublic() ? null : await this.#pack(memory);
    const link = linkOf(packed ? { memory: packed, camera: view } : { ...built, scene: source?.example, camera: view });
    if (!this.#isPublic() && (packed === null || link.length > LONGEST)) return sayBriefly("Too large for a link");
    await copyAddress(`${location.pathname}${search}${link}`);
  }

  async #savePage() {
    const [memory, view] = [await this.app.settled(), this.app.view()];
    if (!memory || !view) return;
    const [script, packed] = await Promise.all([fetched("voxrt-view.js"), packedText(memory)]);
    save(
      new Blob([pageOf(memory.name, script, packed, cameraText(view))], { type: "text/html" }),
      `${memory.name}.html`,
    );
  }
}

/** A page of one file. Its policy lets it fetch nothing. @param {string} name @param {string} script @param {string}
 * packed @param {string} camera */
const pageOf = (name, script, packed, camera) => `<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval'; worker-src blob:; style-src 'unsafe-inline'">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>${name.replace(/[&<]/g, (one) => `&#${one.charCodeAt(0)};`)}</title>
<style>html, body { height: 100%; margin: 0 } voxrt-view { height: 100%; aspect-ratio: auto }</style>
<voxrt-view packed="${packed}" camera="${camera}"></voxrt-view>
<script type="module">${script}</script>
</html>
`;
