// "Copy link": the address in the clipboard, or at least in the address bar.

import { $ } from "./elements.js";

const BRIEF = 1500; // milliseconds

/** Show a text in place of the button's own. @param {string} text */ export function sayBriefly(text) {
  $("copy").textContent = text;
  setTimeout(() => {
    $("copy").textContent = "Copy link";
  }, BRIEF);
}

/** Change the address, and copy it. @param {string} address */ export async function copyAddress(address) {
  history.replaceState(null, "", address);
  const copied = navigator.clipboard?.writeText(location.href);
  sayBriefly((await copied?.then(() => true).catch(() => false)) ? "Copied" : "In the address bar");
}
