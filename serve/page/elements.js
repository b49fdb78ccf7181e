// Elements of the page: found by their id, made, and switched.

export const $ = (id) => document.getElementById(id);
export const pressed = (button, on) => button.setAttribute("aria-pressed", String(on));
export const isPressed = (button) => button.getAttribute("aria-pressed") === "true";

export function makeButton(parent, label, onClick, title = "") {
  const made = document.createElement("button");
  Object.assign(made, { type: "button", textContent: label, title });
  made.addEventListener("click", onClick);
  parent.append(made);
  return made;
}

function makeInput(label, type, limits, onInput) {
  const input = document.createElement("input");
  Object.assign(input, { type, ...limits });
  input.setAttribute("aria-label", label);
  input.addEventListener("input", () => {
    if (input.value !== "") onInput(Number(input.value));
  });
  return input;
}

// A slider with its name; `numbered` adds a field for the number.
export function makeSlider(parent, label, limits, onInput, numbered = false) {
  const row = document.createElement("div");
  row.className = numbered ? "field numbered" : "field";
  const name = document.createElement("span");
  name.textContent = label;
  const inputs = (numbered ? ["range", "number"] : ["range"]).map((type) => makeInput(label, type, limits, onInput));
  row.append(name, ...inputs);
  parent.append(row);
  return {
    set(value) {
      for (const input of inputs) if (input !== document.activeElement || input.type === "range") input.value = value;
    },
    range(low, high) {
      Object.assign(inputs[0], { min: low, max: high });
    },
  };
}

// A toolbar takes one stop of the tab key; arrows, Home and End go from button to button.
export function makeToolbar(bar) {
  const buttons = () => [...bar.querySelectorAll("button")].filter((button) => !button.hidden && !button.disabled);
  const choose = (chosen) => {
    for (const button of bar.querySelectorAll("button")) button.tabIndex = button === chosen ? 0 : -1;
  };
  const refresh = () => choose(buttons().find((button) => button.tabIndex === 0) ?? buttons()[0]);
  bar.addEventListener("focusin", ({ target }) => choose(target));
  bar.addEventListener("keydown", (event) => {
    const all = buttons();
    const at = all.indexOf(document.activeElement);
    const to = {
      ArrowRight: at + 1,
      ArrowDown: at + 1,
      ArrowLeft: at - 1,
      ArrowUp: at - 1,
      Home: 0,
      End: all.length - 1,
    }[event.key];
    if (to === undefined || at < 0) return;
    event.preventDefault();
    all[(to + all.length) % all.length].focus();
  });
  new MutationObserver(refresh).observe(bar, {
    childList: true,
    subtree: true,
    attributeFilter: ["disabled", "hidden"],
  });
  refresh();
}
