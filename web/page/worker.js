// One instance of voxrt off the page's thread: it builds memories, renders rows of frames, follows rays. Messages are
// {id, call, ...}; answers {id, result} or {id, problem}, and {id, stage} before.

import { FLAT } from "./mem.js";
import { answerWith } from "./worker_answers.js";
import { Voxrt } from "./voxrt/voxrt.js";

let voxrt = null;
let parsed = null; // the files that were read last: {source, read}

answerWith({
  async start({ module }) {
    voxrt = await Voxrt.load(module);
  },

  // `source` numbers the files: those that were read last are not read again.
  async build({ files, source, depth, fill, bake, budget }, say) {
    if (parsed?.source !== source) {
      say("Reading");
      const { readFiles } = await import("./files.js");
      parsed = null;
      parsed = { source, read: await readFiles(files, voxrt) };
    }
    const { read } = parsed;
    if (read.memory) return { ...read.memory, name: read.name, file: read.file, fixed: true };
    const start = performance.now();
    say(`Voxelizing ${(2 ** depth).toLocaleString("en")}³`);
    const built = voxrt.voxelize(read.scene, { depth, fill, bake, budget });
    return {
      ...built,
      name: read.name,
      file: read.file,
      fill,
      seconds: (performance.now() - start) / 1000,
      warnings: [...read.scene.warnings, ...built.warnings],
      lighting: built.baked ? FLAT : null,
    };
  },

  memory({ words, depth, shading }) {
    voxrt.setMemory(words, depth);
    voxrt.shade(shading);
  },
  shade({ shading }) {
    voxrt.shade(shading);
  },
  census() {
    return { voxels: voxrt.voxels(), outline: voxrt.outline() };
  },

  render({ camera, size, first, end, buffer }) {
    return voxrt.renderImage(camera, size, first, end, buffer);
  },
  follow({ origin, direction }) {
    return voxrt.follow(origin, direction);
  },
});
