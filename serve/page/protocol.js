// The messages of the frame server (docs/protocol.md), and how its frames are read.

/** @import { Box, Registers, Size } from "./camera.js" @import { Look } from "./light.js" */

export const PROTOCOL = 2;
const HEADER = 56;
export const PART_HEADER = 16;
/** @typedef {{ name: string, size: Size, width_step: number, position_limit: number, features: string[],
 * pixels?: number, smooth?: number }} Device */

/** @typedef {{ protocol: number, viewer: number, device: Device, scenes: string[], suffixes: string[], limits: {
 * chunk: number, upload: number } }} Hello */

/** @typedef {{ number: number, name: string, depth: number, words: number, bounds: Box | null, camera: Registers,
 * size: Size, frames?: number, period?: number | null, voxel_size?: number | null, warnings?: string[], edits?: { number: number, undo: number, redo:
 * number, materials: number } }} Scene */

/** @typedef {Look & { camera: Registers, size: Size, nonstop: boolean, frame: number }} View */

/** @typedef {{ viewers: number, controller: number | null, waiting: number[], scene: Scene, view: View, trouble:
 * string | null }} State */

/** A frame of the screen. `requested`: when this page asked for it; absent for frames of other viewers. @typedef {{
 * width: number, height: number, sequence: number, viewer: number, request: number, rays: number, seconds: number,
 * cycles: number | null, words: number | null, requested?: number }} Frame */

/** @typedef {{ stage: string, done: number, total: number }} Progress of a scene that is loaded */
/** @param {bigint} count */ const counter = (count) => (count === 0xffffffffffffffffn ? null : Number(count));

/** Whether a binary message is a part of saved files. @param {ArrayBuffer} data */
export const isPart = (data) =>
  data.byteLength > PART_HEADER && String.fromCharCode(...new Uint8Array(data, 0, 4)) === "VXCH";

/** Read a frame with its pixels, RGB; null where the message is none. @param {ArrayBuffer} data */
export function readFrame(data) {
  const view = new DataView(data);
  if (data.byteLength < HEADER || String.fromCharCode(...new Uint8Array(data, 0, 4)) !== "VXFR") return null;
  /** @param {number} at */ const u32 = (at) => view.getUint32(at, true);
  /** @type {Frame} */ const frame = {
    width: view.getUint16(6, true),
    height: view.getUint16(8, true),
    sequence: u32(12),
    viewer: u32(24),
    request: u32(28),
    rays: u32(32),
    seconds: u32(36) / 1e6,
    cycles: counter(view.getBigUint64(40, true)),
    words: counter(view.getBigUint64(48, true)),
  };
  const header = view.getUint16(4, true);
  const bytes = u32(16);
  if (bytes !== data.byteLength - header || bytes !== 3 * frame.width * frame.height) return null;
  return { ...frame, pixels: new Uint8Array(data, header) };
}
