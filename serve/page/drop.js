// Files that are chosen, or dropped anywhere on the page.

import { $ } from "./elements.js";

/** @param {(files: File[]) => void} open */ export function acceptFiles(open) {
  $("files").onchange = () => {
    open([...($("files").files ?? [])]);
    $("files").value = "";
  };
  let depth = 0; // elements that the pointer has entered and not left
  /** @param {number} now */ const enter = (now) => {
    depth = Math.max(0, now);
    $("drop").hidden = depth === 0;
  };
  addEventListener("dragenter", (event) => {
    event.preventDefault();
    enter(depth + 1);
  });
  addEventListener("dragleave", () => enter(depth - 1));
  addEventListener("dragover", (event) => event.preventDefault());
  addEventListener("drop", async (event) => {
    event.preventDefault();
    enter(0);
    if (event.dataTransfer) open(await filesOf(event.dataTransfer));
  });
}

/** Every file of a drop, those in folders too. @param {DataTransfer} transfer */
async function filesOf(transfer) {
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry?.()).filter((entry) => entry !== null);
  if (!entries.some((entry) => entry?.isDirectory)) return [...transfer.files];
  /** @type {File[]} */ const found = [];
  for (const entry of entries) await collect(entry, found);
  return found;
}

/** @param {FileSystemEntry} entry @param {File[]} found */ async function collect(entry, found) {
  if (entry.isFile) {
    const { file } = /** @type {FileSystemFileEntry} */ (entry);
    found.push(await new Promise((resolve, reject) => file.call(entry, resolve, reject)));
    return;
  }
  const reader = /** @type {FileSystemDirectoryEntry} */ (entry).createReader();
  for (;;) {
    /** @type {FileSystemEntry[]} */
    const some = await new Promise((resolve, reject) => reader.readEntries(resolve, reject));
    if (!some.length) return;
    for (const child of some) await collect(child, found);
  }
}
