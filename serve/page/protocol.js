// The messages of the frame server (docs/protocol.md), and how its frames are read.

/** @import { Box, Registers, Size } from "./camera.js" */
/** @import { Look } from "./light.js" */

export const PROTOCOL = 2;
const HEADER = 56;

/** @typedef {{ name: string, size: Size, width_step: number, position_limit: number, features: string[] }} Device */

/**
 * @typedef {object} Hello
 * @property {number} protocol
 * @property {number} viewer
 * @property {Device} device
 * @property {string[]} scenes
 * @property {string[]} suffixes
 * @property {{ chunk: number, upload: number }} limits
 */

/**
 * @typedef {object} Scene
 * @property {number} number
 * @property {string} name
 * @property {number} depth
 * @property {number} words
 * @property {Box | null} bounds
 * @property {Registers} camera
 * @property {Size} size
 * @property {number} [frames]
 * @property {number | null} [period]
 */

/** @typedef {Look & { camera: Registers, size: Size, nonstop: boolean, frame: number }} View */

/**
 * @typedef {object} State
 * @property {number} viewers
 * @property {number | null} controller
 * @property {number[]} waiting
 * @property {Scene} scene
 * @property {View} view
 * @property {string | null} trouble
 */

/**
 * A frame of the screen. `requested`: when this page asked for it; absent for frames of other viewers.
 * @typedef {object} Frame
 * @property {number} width
 * @property {number} height
 * @property {number} sequence
 * @property {number} viewer
 * @property {number} request
 * @property {number} rays
 * @property {number} seconds
 * @property {number | null} cycles
 * @property {number | null} words
 * @property {number} [requested]
 */

/** @typedef {{ stage: string, done: number, total: number }} Progress of a scene that is loaded */

/** @param {bigint} count */
const counter = (count) => (count === 0xffffffffffffffffn ? null : Number(count));

/** Read a frame with its pixels, RGB; null where the message is none. @param {ArrayBuffer} data */
export function readFrame(data) {
  const view = new DataView(data);
  if (data.byteLength < HEADER || String.fromCharCode(...new Uint8Array(data, 0, 4)) !== "VXFR") return null;
  /** @param {number} at */
  const u32 = (at) => view.getUint32(at, true);
  /** @type {Frame} */
  const frame = {
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
