// The verilated hardware in Node: {words, depth, camera, size, look} in; hashes, clocks and problems out.
import { answer, fileOf, importOf, sha } from "./jobs.mjs";

const { Hardware } = await importOf("voxrt/hardware.js");
const { Voxrt } = await importOf("voxrt/voxrt.js");
const voxrt = await Voxrt.load(await fileOf("voxrt/voxrt.wasm"));

let pixels = [];
const hardware = await Hardware.start(await fileOf("voxrt/voxrt_hardware.wasm"), (ready) => pixels.push(ready));

await answer(
  ({ words, zeros, depth, camera, size, look, limit }) => {
    pixels = [];
    hardware.setMemory(zeros ? new Uint32Array(zeros) : Uint32Array.from(words), depth);
    const { colour, material, face, clocks, wordsRead } = hardware.render(camera, size, look);
    voxrt.setMemory(Uint32Array.from(words), depth);
    return { colour: sha(colour), material: sha(material), face: sha(face), clocks, wordsRead, pixels, level: voxrt.levelThatFits(limit) };
  },
  () => ({ limit: hardware.wordLimit }),
);
