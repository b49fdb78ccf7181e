// What the page says over the picture: notices with progress, and why there is no connection.

import { $, part } from "./elements.js";
/** @import { Refusal } from "./refusal.js" */

const box = () => $("notice");

/** `progress`: the part that is done, null for no bar. `cancel`: what a button does, null for none. @param {"error"
 * | "progress"} kind @param {string} title @param {string} [text] @param {{ progress?: number | null, cancel?: (()
 * => void) | null }} [options] */
export function notice(kind, title, text = "", { progress = null, cancel = null } = {}) {
  box().hidden = false;
  box().dataset.kind = kind;
  box().setAttribute("role", kind === "error" ? "alert" : "status");
  part(box(), "strong").textContent = title;
  part(box(), "p").textContent = text;
  const bar = part(box(), "progress");
  bar.hidden = progress === null;
  if (progress !== null) bar.value = progress;
  $("cancel").hidden = cancel === null;
  $("cancel").onclick = cancel;
  $("close").hidden = kind !== "error";
}

export const dismiss = () => {
  box().hidden = true;
};

/** @param {Refusal} refusal @param {number} seconds until the next try */
export function showAway({ reason, text = "" }, seconds) {
  const [title, advice] = {
    token: ["The token is missing or wrong", "Enter the token that the server printed at its start."],
    origin: ["The server does not know this address", text || `Start it with --origin ${location.origin}`],
    full: ["The server has too many viewers", "The page tries again by itself."],
    version: ["The server has another version", "Load this page again."],
    gone: ["The server does not answer", "Is it still running? The page connects again when it is back."],
    lost: ["The connection was lost", "The page connects again by itself."],
  }[reason];
  $("away").hidden = false;
  part($("away"), "h2").textContent = title;
  part($("away"), "p").textContent = advice;
  $("token-form").hidden = reason !== "token";
  $("retry").hidden = reason === "token";
  $("retry").title = `It tries again in ${Math.ceil(seconds)} s`;
}

export const hideAway = () => {
  $("away").hidden = true;
};
