// Elements of the page: found by their id, made, and switched.

/** The elements that are more than an HTMLElement. @typedef {"files" | "depth" | "budget" | "budget-words" | "sun-x"
 * | "sun-y" | "sun-z" | "sky" | "samples" | "frames" | "bounces" | "background"} Inputs */
/** @typedef {{ picture: HTMLCanvasElement, "hardware-picture": HTMLCanvasElement, octants: SVGSVGElement, size:
 * HTMLSelectElement, up: HTMLSelectElement, unit: HTMLSelectElement, fill: HTMLSelectElement, rule: HTMLSelectElement, keys: HTMLDialogElement, advanced: HTMLDetailsElement } & Record<Inputs, HTMLInputElement> &
 * Record<"take" | "bake" | "turntable", HTMLButtonElement> & Record<"token-form" | "save-view", HTMLFormElement> &
 * Record<"hardware-progress" | "bitstream-progress", HTMLProgressElement>} Elements */

/** The element of the page with an id. @template {string} I @param {I} id */
export const $ = (id) => {
  const found = /** @type {unknown} */ (document.getElementById(id));
  return /** @type {I extends keyof Elements ? Elements[I] : HTMLElement} */ (found);
};

/** An element below another one. @template {keyof HTMLElementTagNameMap} T @param {Element} parent @param {T} tag */
export const part = (parent, tag) => /** @type {HTMLElementTagNameMap[T]} */ (parent.querySelector(tag));

/** All elements that match a selector. @param {string} selector @param {ParentNode} [parent] */
export const all = (selector, parent = document) =>
  /** @type {HTMLElement[]} */ ([...parent.querySelectorAll(selector)]);

/** @param {Element} button @param {boolean} on */
export const pressed = (button, on) => button.setAttribute("aria-pressed", String(on));
/** @param {Element} button */ export const isPressed = (button) => button.getAttribute("aria-pressed") === "true";

/** Make an element. Properties whose name has a dash are attributes. @template {keyof HTMLElementTagNameMap} T
 * @param {T} tag @param {Record<string, unknown>} [properties] @param {(Node | string)[]} children */
export function element(tag, properties = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name.includes("-")) made.setAttribute(name, String(value));
    else Object.assign(made, { [name]: value });
  }
  made.append(...children);
  return made;
}

/** Make an element of a drawing. @param {string} tag @param {Record<string, string | number>} attributes */
export function svgElement(tag, attributes) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, String(value));
  return made;
}

/** @param {Element} parent @param {string} label @param {() => void} onclick */
export function makeButton(parent, label, onclick, title = "") {
  const made = element("button", { type: "button", textContent: label, title, onclick });
  parent.append(made);
  return made;
}

/** Show terms and values, each pair in a box. @param {HTMLElement} list @param {Record<string, string>} facts */
export function showFacts(list, facts) {
  const boxes = Object.entries(facts).map(([term, value]) =>
    element("div", {}, element("dt", {}, term), element("dd", {}, value)),
  );
  list.replaceChildren(...boxes);
}

/** @typedef {{ min?: number, max?: number, step?: number }} Limits */
/** @typedef {(value: number) => void} OnNumber */

/** @param {string} label @param {string} type @param {Limits} limits @param {OnNumber} onInput */
function makeInput(label, type, limits, onInput) {
  const input = element("input", { type, ...limits, "aria-label": label });
  input.addEventListener("input", () => {
    if (input.value !== "") onInput(Number(input.value));
  });
  return input;
}

/** A slider; `numbered` adds a field. @param {HTMLElement} parent @param {string} label @param {Limits} limits
 * @param {OnNumber} onInput */
export function makeSlider(parent, label, limits, onInput, numbered = false) {
  const inputs = (numbered ? ["range", "number"] : ["range"]).map((type) => makeInput(label, type, limits, onInput));
  parent.append(
    element("div", { className: numbered ? "field numbered" : "field" }, element("span", {}, label), ...inputs),
  );
  return {
    /** @param {number | string} value */ set(value) {
      for (const input of inputs)
        if (input !== document.activeElement || input.type === "range") input.value = String(value);
    },
    /** @param {number} low @param {number} high */ range(low, high) {
      Object.assign(inputs[0], { min: low, max: high });
    },
  };
}

/** A toolbar takes one stop of the tab key; arrows, Home and End go from button to button. @param {HTMLElement} bar */
export function makeToolbar(bar) {
  const buttons = () => [...bar.querySelectorAll("button")].filter((button) => !button.hidden && !button.disabled);
  /** @param {EventTarget | null} chosen */ const choose = (chosen) => {
    for (const button of bar.querySelectorAll("button")) button.tabIndex = button === chosen ? 0 : -1;
  };
  const refresh = () => choose(buttons().find((button) => button.tabIndex === 0) ?? buttons()[0]);
  bar.addEventListener("focusin", ({ target }) => choose(target));
  bar.addEventListener("keydown", (event) => {
    const enabled = buttons();
    const at = enabled.indexOf(/** @type {HTMLButtonElement} */ (document.activeElement));
    const [next, last] = [at + 1, enabled.length - 1];
    /** @type {Record<string, number>} */
    const places = { ArrowRight: next, ArrowDown: next, ArrowLeft: at - 1, ArrowUp: at - 1, Home: 0, End: last };
    const to = places[event.key];
    if (to === undefined || at < 0) return;
    event.preventDefault();
    enabled[(to + enabled.length) % enabled.length].focus();
  });
  const attributeFilter = ["disabled", "hidden"];
  new MutationObserver(refresh).observe(bar, { childList: true, subtree: true, attributeFilter });
  refresh();
}
