// Which axis is up and how long a unit is, in files of formats that do not state it.

/** @import { Scene } from "./voxrt/voxrt.js" */

/** What the user chose; null: as voxrt build takes it. @typedef {{ up: string | null, unit: number | null }} Placing */

/** @type {Record<string, string>} the up axis, by the extension of the file */
export const UPWARDS = { stl: "z", obj: "y", ply: "y" };
/** @type {Record<string, number[][]>} rows of the rotation that makes y the up axis */
const ROTATIONS = {
  y: [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
  ],
  z: [
    [1, 0, 0],
    [0, 0, 1],
    [0, -1, 0],
  ],
};

/** The scene with y up, in metres. @template {Scene} S @param {S} scene @param {string} kind the extension of the file
 * @param {Placing} placing @returns {S} */
export function placed(scene, kind, { up, unit }) {
  const turned = ROTATIONS[up ?? UPWARDS[kind]];
  if (!(kind in UPWARDS)) return scene;
  const objects = scene.objects.map(({ transform, ...object }) => {
    const rows = turned.flatMap((row) =>
      [0, 1, 2, 3].map(
        (column) => (unit ?? 1) * row.reduce((sum, part, i) => sum + part * transform[4 * i + column], 0),
      ),
    );
    return { ...object, transform: rows };
  });
  return { ...scene, objects };
}
