// The toolbar over the picture, and what else both pages have: figures, panel, full screen, keys.

import { $, isPressed, makeToolbar, pressed } from "./elements.js";
import { dismiss } from "./notices.js";

/** @typedef {Record<string, () => void>} Commands functions by the code of a key */

/** Connect the buttons; returns the commands that every page has. */
export function makeTools() {
  $("help").onclick = () => $("keys").showModal();
  $("close").onclick = dismiss;
  makeToolbar($("tools"));

  /** @param {boolean} on */ const setFigures = (on) => {
    pressed($("statistics"), on);
    $("figures").hidden = !on;
  };
  $("statistics").onclick = () => setFigures(!isPressed($("statistics")));
  setFigures(!matchMedia("(max-width: 56rem), (max-height: 30rem)").matches);

  $("toggle-panel").onclick = () => {
    const hidden = document.body.classList.toggle("panel-hidden");
    $("toggle-panel").setAttribute("aria-expanded", String(!hidden));
  };

  $("fullscreen").hidden = !document.fullscreenEnabled;
  $("fullscreen").onclick = () =>
    document.fullscreenElement ? document.exitFullscreen() : $("stage").requestFullscreen();
  document.addEventListener("fullscreenchange", () => pressed($("fullscreen"), document.fullscreenElement !== null));
  $("picture").addEventListener("keydown", ({ code }) => {
    if (code === "Enter") $("fullscreen").click();
  });
  return { KeyO: () => $("statistics").click(), KeyP: () => $("save").click(), KeyH: () => $("help").click() };
}
