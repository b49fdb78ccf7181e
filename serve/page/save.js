// Files that the browser saves.

/** @param {string} name @param {string} extension */
export const fileName = (name, extension) => `${name.replace(/[^\w.-]+/g, "_")}.${extension}`;

/** @param {Blob} blob @param {string} name */ export function save(blob, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
