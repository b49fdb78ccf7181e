// The files that were dropped together.

/** @typedef {{ name: string, bytes: Uint8Array<ArrayBuffer> }} DroppedFile */

export class FileError extends Error {
  name = "FileError";
}

/** @param {string} name */ export const stem = (name) => name.replace(/\.[^.]*$/, "");

/** @param {string} name */ export const extension = (name) => name.slice(name.lastIndexOf(".") + 1).toLowerCase();

/** @param {string} name */ function decoded(name) {
  try {
    return decodeURIComponent(name);
  } catch {
    return name; // a plain name with "%"
  }
}

/** The name of the file at an address. @param {URL} url */
export const nameOf = ({ pathname }) => decoded(pathname.replace(/^.*\//, ""));

export class Folder {
  /** @param {DroppedFile[]} files */ constructor(files) {
    this.files = new Map(files.map((file) => [file.name.toLowerCase(), file]));
  }

  /** The file of a path that a scene names. @param {string} path */
  find(path) {
    const plain = decoded(path).replaceAll("\\", "/").replace(/^.*\//, "");
    return this.files.get(plain.toLowerCase());
  }
}
