// What the page says over the picture: notices with progress, and why there is no connection.

import { $ } from "./elements.js";

const box = () => $("notice");

export function notice(kind, title, text = "", { progress = null, cancel = null } = {}) {
  box().hidden = false;
  box().dataset.kind = kind;
  box().setAttribute("role", kind === "error" ? "alert" : "status");
  box().querySelector("strong").textContent = title;
  box().querySelector("p").textContent = text;
  const bar = box().querySelector("progress");
  bar.hidden = progress === null;
  if (progress !== null) bar.value = progress;
  $("cancel").hidden = cancel === null;
  $("cancel").onclick = cancel;
  $("close").hidden = kind !== "error";
}

export const dismiss = () => {
  box().hidden = true;
};
export const noticeKind = () => (box().hidden ? null : box().dataset.kind);

// `reason` is one of those of refusal.js, or "lost".
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
  $("away").querySelector("h2").textContent = title;
  $("away").querySelector("p").textContent = advice;
  $("token-form").hidden = reason !== "token";
  $("retry").hidden = reason === "token";
  $("retry").title = `It tries again in ${Math.ceil(seconds)} s`;
}

export const hideAway = () => {
  $("away").hidden = true;
};
