// The controls of editing over the picture: tools, brush, materials, undo and redo, figures.

import { $, all, element, makeToolbar, pressed } from "./elements.js";
/** @import { Tool } from "./edit_pointer.js" */

/** `blocks` of the octree; `fresh`: blocks that the newest edits have made, or brought back; `freed`: blocks that voxels no
 * longer need; steps that there are. @typedef {{ blocks: number, fresh: number, freed: number, undo: number, redo: number }}
 * EditFigures */
/** `colour`: red, green, blue. @typedef {{ name: string, colour: readonly number[] }} Material */

/** @typedef {Tool | "look"} ToolChoice */
/** @typedef {{ tool: ToolChoice, size: number, material: number }} Choice */

/** What the controls do. @typedef {{ choose: (some: Partial<Choice>) => void, addColour: (colour: number[]) => void,
 * move: (way: "undo" | "redo") => void }} EditActions */

/** Voxels across. */
export const SIZES = [1, 2, 3, 5, 7, 9, 13, 17, 25, 33, 49, 65];
const KEPT = "Of the newest edits. Blocks that Undo needs are kept.";
/** @type {[ToolChoice, string, string][]} */ const TOOLS = [
  ["look", "Look", "Drag turns, as without tools (Esc)"],
  ["dig", "Dig", "Left button digs, right button builds"],
  ["build", "Build", "Left button builds, right button digs"],
  ["paint", "Paint", "Left button colours solid voxels, right button builds"],
];
/** @param {number} number */ const count = (number) => number.toLocaleString("en");

export class EditBar {
  /** @param {EditActions} actions */ constructor(actions) {
    const tools = TOOLS.map(([tool, text, title]) =>
      element("button", { type: "button", title, "data-tool": tool, onclick: () => actions.choose({ tool }) }, text),
    );
    this.undo = element("button", { type: "button", title: "Ctrl Z", onclick: () => actions.move("undo") }, "Undo");
    this.redo = element("button", { type: "button", title: "Ctrl Y", onclick: () => actions.move("redo") }, "Redo");
    this.size = element("input", { type: "range", min: 0, max: SIZES.length - 1, step: 1, "aria-label": "Brush size" });
    this.size.oninput = () => actions.choose({ size: SIZES[this.size.valueAsNumber] });
    this.shownSize = element("output", { title: "Voxels across; keys [ and ]" });
    this.colour = element("input", {
      type: "color",
      value: "#f2c230",
      "aria-label": "New colour",
      title: "New colour",
    });
    this.colour.onchange = () =>
      actions.addColour([1, 3, 5].map((at) => Number.parseInt(this.colour.value.slice(at, at + 2), 16)));
    this.swatches = element("div", { id: "swatches", role: "toolbar", "aria-label": "Materials" });
    this.figures = element("p", { id: "edit-figures", className: "quiet figure", title: KEPT });
    const bar = element(
      "div",
      { id: "edit-tools", role: "toolbar", "aria-label": "Tools" },
      ...tools,
      this.undo,
      this.redo,
    );
    const brush = element("label", { className: "brush", title: "Brush size" }, "Brush", this.size, this.shownSize);
    const fresh = element("label", { className: "new" }, "New colour", this.colour);
    this.box = element(
      "div",
      { id: "edit", role: "group", "aria-label": "Edit" },
      bar,
      brush,
      fresh,
      this.swatches,
      this.figures,
    );
    this.box.hidden = true;
    $("stage").append(this.box);
    document.head.append(element("link", { rel: "stylesheet", href: "edit.css" }));
    makeToolbar(bar);
    makeToolbar(this.swatches);
    this.actions = actions;
  }

  /** @param {Choice} choice */ show({ tool, size, material }) {
    for (const button of all("button[data-tool]", this.box)) pressed(button, button.dataset.tool === tool);
    this.size.valueAsNumber = SIZES.indexOf(size);
    this.size.setAttribute("aria-valuetext", size === 1 ? "1 voxel" : `${size} voxels`);
    this.shownSize.textContent = String(size);
    for (const swatch of all("button", this.swatches)) {
      const isChosen = Number(swatch.dataset.id) === material;
      pressed(swatch, isChosen);
      if (isChosen) swatch.scrollIntoView({ block: "nearest", inline: "nearest" });
    }
  }

  /** @param {readonly Material[]} materials */ showMaterials(materials) {
    const made = materials.slice(1).map(({ name, colour }, i) => {
      const known = { type: "button", title: name, "aria-label": name, "data-id": i + 1 };
      const swatch = element("button", { ...known, onclick: () => this.actions.choose({ material: i + 1 }) });
      swatch.style.backgroundColor = `rgb(${colour.join()})`;
      return swatch;
    });
    this.swatches.replaceChildren(...made);
  }

  /** @param {EditFigures} figures */ showFigures({ blocks, fresh, freed, undo, redo }) {
    this.undo.disabled = !undo;
    this.redo.disabled = !redo;
    this.figures.textContent = `${count(8 * blocks + 1)} words · ${count(fresh)} new blocks · ${count(freed)} freed blocks`;
  }
}
