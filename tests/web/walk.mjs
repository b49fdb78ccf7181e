// Who walks, in Node: {words, depth, boxes} in, whether each box meets what is solid, out; {words, depth, voxelSize, place,
// wishes} in, where the body is after each wish, out.
import { answer, importOf } from "./jobs.mjs";

const { bodyBox, bodyFor, eyeOf, roomAbove, step } = await importOf("walk.js");
const { meetsSolid } = await importOf("solids.js");

await answer(({ words, depth, boxes, voxelSize, place, wishes, builtIn }) => {
  const octree = { words: Uint32Array.from(words), depth, root: words[0] };
  if (boxes) return boxes.map(([low, high]) => meetsSolid(octree, low, high));
  const side = 2 ** depth;
  const meets = (low, high) =>
    low[1] < 0 || Math.min(low[0], low[2]) < 0 || Math.max(high[0], high[2]) > side || meetsSolid(octree, low, high);
  const body = bodyFor(voxelSize, side);
  let walk = { place: builtIn ? place : roomAbove(place, body, side, meets), rise: 0, stands: false, lag: 0 };
  const steps = wishes.map((wish) => {
    walk = step(walk, body, { right: 0, forward: 0, yaw: 0, pace: 1, jump: false, ...wish }, wish.seconds ?? 1 / 60, meets);
    return { ...walk, box: bodyBox(walk.place, body), eye: eyeOf(walk, body) };
  });
  return { body, steps };
});
