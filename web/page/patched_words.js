// Words that patches are written into.

export class PatchedWords {
  /** @param {Uint32Array} words @param {number} depth */ constructor(words, depth) {
    this.words = words.slice();
    this.depth = depth;
    this.root = words[0];
  }

  /** @param {import("./voxrt/world.js").Patch} patch */ apply({ rootWord, addresses, blocks }) {
    const end = addresses.length ? addresses[addresses.length - 1] + 8 : 0;
    if (end > this.words.length) {
      const grown = new Uint32Array(2 * end);
      grown.set(this.words);
      this.words = grown;
    }
    for (const [i, address] of addresses.entries()) this.words.set(blocks.subarray(8 * i, 8 * i + 8), address);
    this.root = rootWord;
  }
}
