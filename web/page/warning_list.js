// What a memory lost or changed: a sentence each, and a button where an option mends it.

import { $, element } from "./elements.js";
/** @import { App } from "./app.js" @import { Choices } from "./choices.js" @import { Shown } from "./memory.js" @import { Warning } from "./voxrt/voxrt.js" */

/** @typedef {{ text: string, label?: string, mend?: () => void }} Sentence */

const MOST = 3; // sentences that are shown at once
const TURNED = "Some faces look inwards; they were turned.";

/** @param {number} depth */ const side = (depth) => `${(2 ** depth).toLocaleString("en")}³`;

export class WarningList {
  /** @param {App} app */ constructor(app) {
    this.app = app;
  }

  /** @param {Shown} memory */ show(memory) {
    const sentences = new Map(
      memory.warnings.map((warning) => this.#sentence(warning, memory)).map((one) => [one.text, one]),
    );
    const found = [...sentences.values()].sort((a, b) => Number(Boolean(b.mend)) - Number(Boolean(a.mend)));
    const edited = { text: "The voxels are edited. Open the model again to build it otherwise." };
    const all = [...(memory.edited ? [edited] : []), ...this.#ruin(memory), ...found].map((one) =>
      this.#row(one, memory),
    );
    const rest = all.splice(MOST);
    const more = element("details", {}, element("summary", {}, `${rest.length} more`), element("ul", {}, ...rest));
    $("warnings").replaceChildren(...all, ...(rest.length ? [element("li", {}, more)] : []));
  }

  /** What a budget gave up, if it is much. @param {Shown} memory @returns {Sentence[]} */
  #ruin({ rule, fitted, lossless }) {
    if (!fitted || !lossless) return [];
    const part = `${((100 * fitted.changed) / fitted.surface).toFixed(0)} %`;
    const text = `The budget gives up ${part} of the surface. ${side(lossless.depth)} fits without loss.`;
    const coarse = { text: "Coarse voxels look nearer to the model by rule Centre.", label: "Use Centre" };
    const mend = () => this.#choose({ rule: "centre" });
    return [{ text, ...this.#resolve(lossless.depth) }, ...(rule === "touch" ? [{ ...coarse, mend }] : [])];
  }

  /** @param {Warning} warning @param {Shown} memory */ #sentence({ kind, message, count }, memory) {
    const missing = message.match(/'(.+)' (was not found|in the asset's folder)/)?.[1];
    if (missing) return { text: `${missing} is missing: drop it together with the model.` };
    const list = message.slice(message.indexOf(": ") + 2);
    const names = message.match(/\((.+)\): build/)?.[1];
    /** @type {Record<string, Sentence>} */ const known = {
      "no-voxels": { text: `Too small to show at ${side(memory.depth)}: ${list}.`, ...this.#resolve(memory.depth + 1) },
      "open-surface": { text: "Open parts, like a room without a front, are hollow.", ...this.#fill("solid") },
      "mostly-filled": { text: `Open parts were filled: ${names}.`, ...this.#fill("surface") },
      "one-sided": { text: "Some parts have no clear inside; they were filled.", ...this.#fill("surface") },
      "up-axis": { text: "It seems to lie on its back.", label: "Stand it up", mend: () => this.#choose({ up: "z" }) },
      "turned-pieces": { text: TURNED },
      "turned-faces": { text: TURNED },
      "default-material": { text: "Parts without a material are grey." },
    };
    const times = count > 1 ? ` (${count.toLocaleString("en")})` : "";
    return Object.hasOwn(known, kind)
      ? known[kind]
      : { text: `${message.charAt(0).toUpperCase()}${message.slice(1)}${times}.` };
  }

  /** @param {"solid" | "surface"} fill */ #fill(fill) {
    return { label: fill === "solid" ? "Fill them" : "Keep them hollow", mend: () => this.#choose({ fill }) };
  }

  /** @param {Partial<Choices["options"]>} some */ #choose(some) {
    this.app.panel.choices.choose(some, () => this.app.build());
  }

  /** @param {number} depth */ #resolve(depth) {
    if (depth < Number($("depth").min) || depth > Number($("depth").max)) return {};
    const mend = () => {
      $("depth").valueAsNumber = depth;
      this.app.build();
    };
    return { label: `Use ${side(depth)}`, mend };
  }

  /** A memory that was read cannot be built otherwise. @param {Sentence} sentence @param {Shown} memory */
  #row({ text, label, mend }, { fixed }) {
    const button = !fixed && label && element("button", { type: "button", onclick: mend }, label);
    return element("li", {}, element("span", {}, text), ...(button ? [button] : []));
  }
}
