// Worlds that are edited in Node: {words, depth, materials, limits, steps} in; what each step returns, and hashes, out.
import { answer, fileOf, importOf, sha } from "./jobs.mjs";

const { Voxrt } = await importOf("voxrt/voxrt.js");
const { World } = await importOf("voxrt/world.js");
const editing = await Voxrt.load(await fileOf("voxrt/voxrt_edit.wasm"));
const picture = await Voxrt.load(await fileOf("voxrt/voxrt.wasm"));

await answer(({ words, depth, materials, limits, steps, camera, size }) => {
  const world = new World(editing, { words: Uint32Array.from(words), depth, materials }, limits);
  picture.setMemory(world.image(), depth);
  picture.shade({ materials: materials.map(({ colour }) => colour) });
  let live = 0;
  const results = steps.map(([call, ...values]) => {
    try {
      if (call === "stroke") {
        world.stroke = values[0];
        return null;
      }
      if (call !== "commit") return world[call](...values) ?? null;
      const patch = world.commit();
      picture.applyPatch(patch);
      if (patch.root !== live) world.release(live);
      live = patch.root;
      const { colour } = picture.render(camera, size);
      const { addresses, blocks, root, rootWord } = patch;
      const written = { root, rootWord, addresses: [...addresses], patch: sha(blocks) };
      return { ...written, words: sha(world.words()), image: sha(world.image()), colour: sha(colour), ...world.figures() };
    } catch ({ name, message }) {
      return { problem: `${name}: ${message}` };
    }
  });
  const left = world.steps;
  world.end();
  return { results, steps: left, materials: world.materials };
});
