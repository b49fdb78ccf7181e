// The 32-bit words of an octree memory, of dialect "report": octree/words.py describes them. In JavaScript this module
// alone knows their bits.

/** The dialect that pages and the package read and write. */
export const DIALECT = "report";

/** Whether a word is a leaf, and no pointer to a block. @param {number} word */
export const isLeaf = (word) => word >>> 31 === 1;

/** The material id of a leaf; 0 is empty space. @param {number} word */
export const material = (word) => word & 0xff;

/** The leaf of a material id. @param {number} id */
export const leaf = (id) => 0xffffff00 + id;

/** The octant of a pointer's block that an address has. @param {number} pointer @param {number} address */
export const octant = (pointer, address) => (address - pointer) & 7;

/** Eight hexadecimal digits. @param {number} word */
export const hex = (word) => word.toString(16).toUpperCase().padStart(8, "0");
