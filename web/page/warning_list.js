// What a memory lost or changed: a sentence each, and a button where an option mends it.

import { $, element } from "./elements.js";
/** @import { App } from "./app.js" @import { Choices } from "./choices.js" @import { Shown } from "./memory.js" @import { Warning } from "./voxrt/voxrt.js" */

/** @typedef {{ text: string, label?: string, mend?: () => void }} Sentence */

const MOST = 3; // sentences that are shown at once
const RUINED = 0.1; // part of the surface that a budget may change
const TURNED = "Some faces look inwards; they were turned.";

/** @param {number} depth */ const side = (depth) => `${(2 ** depth).toLocaleString("en")}³`;

export class WarningList {
  /** @param {App} app */ constructor(app) {
    this.app = app;
  }

  /** @param {Shown} memory */ show(memory) {
    const { fitted } = memory;
    const sentences = new Map(
      memory.warnings.map((warning) => this.#sentence(warning, memory)).map((one) => [one.text, one]),
    );
    const changed = fitted ? fitted.changed / (fitted.surface || 1) : 0;
    const ruin = {
      text: `The budget changed ${(100 * changed).toFixed(1)} % of the surface.`,
      ...this.#resolve(memory, -1),
    };
    const found = [...sentences.values()].sort((a, b) => Number(Boolean(b.mend)) - Number(Boolean(a.mend)));
    const all = [...(changed > RUINED ? [ruin] : []), ...found].map((one) => this.#row(one));
    const rest = all.splice(MOST);
    const more = element("details", {}, element("summary", {}, `${rest.length} more`), element("ul", {}, ...rest));
    $("warnings").replaceChildren(...all, ...(rest.length ? [element("li", {}, more)] : []));
  }

  /** @param {Warning} warning @param {Shown} memory */ #sentence({ kind, message, count }, memory) {
    const missing = message.match(/'(.+)' (was not found|in the asset's folder)/)?.[1];
    if (missing) return { text: `${missing} is missing: drop it together with the model.` };
    const list = message.slice(message.indexOf(": ") + 2);
    const names = message.match(/\((.+)\): build/)?.[1];
    /** @type {Record<string, Sentence>} */ const known = {
      "no-voxels": { text: `Too small to show at ${side(memory.depth)}: ${list}.`, ...this.#resolve(memory, 1) },
      "open-surface": { text: "Open parts, like a room without a front, are hollow.", ...this.#fill("solid", memory) },
      "mostly-filled": { text: `Open parts were filled: ${names}.`, ...this.#fill("surface", memory) },
      "one-sided": { text: "Some parts have no clear inside; they were filled.", ...this.#fill("surface", memory) },
      "up-axis": { text: "It seems to lie on its back.", label: "Stand it up", mend: () => this.#choose({ up: "z" }) },
      "turned-pieces": { text: TURNED },
      "turned-faces": { text: TURNED },
      "default-material": { text: "Parts without a material are grey." },
    };
    const times = count > 1 ? ` (${count.toLocaleString("en")})` : "";
    return known[kind] ?? { text: `${message[0].toUpperCase()}${message.slice(1)}${times}.` };
  }

  /** @param {"solid" | "surface"} fill @param {Shown} memory */ #fill(fill, { fixed }) {
    if (fixed) return {};
    return { label: fill === "solid" ? "Fill them" : "Keep them hollow", mend: () => this.#choose({ fill }) };
  }

  /** @param {Partial<Choices["options"]>} some */ #choose(some) {
    this.app.panel.choices.choose(some, () => this.app.build());
  }

  /** @param {Shown} memory @param {number} levels more */ #resolve({ depth, fixed }, levels) {
    const better = depth + levels;
    if (fixed || better < Number($("depth").min) || better > Number($("depth").max)) return {};
    return {
      label: `Use ${side(better)}`,
      mend: () => {
        $("depth").valueAsNumber = better;
        this.app.build();
      },
    };
  }

  /** @param {Sentence} sentence */ #row({ text, label, mend }) {
    const button = label && element("button", { type: "button", onclick: mend }, label);
    return element("li", {}, element("span", {}, text), ...(button ? [button] : []));
  }
}
