// "Turntable": a film of one turn around what is shown, recorded by the browser.

import { element } from "./elements.js";
import { orbit } from "./navigation.js";
import { dismiss, notice } from "./notices.js";
import { fileName, save } from "./save.js";
import { still } from "./stills.js";
import { scale } from "./vectors.js";
/** @import { App } from "./app.js" */

const SECONDS = 5;
const RATE = 25; // frames per second
const BITS = 8_000_000; // per second
const WIDEST = 960; // columns: registers are coarse where there are more, and the film would tremble
const NARROWEST = 320;
const SHARE = 0.6; // of a frame's time that its rays may take
const RAYS = 4; // per pixel
const KINDS = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm", "video/mp4"];
/** @param {number} time */ const until = (time) =>
  new Promise((resolve) => setTimeout(resolve, Math.max(0, time - performance.now())));

/** Columns and rows, even, that this device renders in time. @param {App} app */ function sizeOf(app) {
  const { size } = app;
  const [width, height] = size();
  const cost = app.frames.resolution.seconds([width, height]) * RAYS;
  const part = Math.min(WIDEST / width, Math.max(NARROWEST / width, Math.sqrt(SHARE / RATE / (cost || 1))));
  return scale([width, height], part / 2).map((side) => 2 * Math.round(side));
}

/** @param {App} app */ export async function record(app) {
  const [memory, view] = [app.memory(), app.view()];
  if (!memory || !view) return;
  const kind = globalThis.MediaRecorder && KINDS.find((one) => MediaRecorder.isTypeSupported(one));
  if (!kind) throw new Error("this browser records no films; try another one, or voxrt render --turntable");
  const size = sizeOf(app);
  const canvas = element("canvas", { width: size[0], height: size[1] });
  const context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d", { alpha: false }));
  let isCancelled = false;
  const cancel = () => {
    isCancelled = true;
  };
  const frames = SECONDS * RATE;
  context.putImageData(await still(app.painter, view, size), 0, 0);
  const recorder = new MediaRecorder(canvas.captureStream(RATE), { mimeType: kind, videoBitsPerSecond: BITS });
  /** @type {Blob[]} */ const parts = [];
  recorder.ondataavailable = ({ data }) => parts.push(data);
  const ended = new Promise((resolve) => {
    recorder.onstop = resolve;
  });
  recorder.start();
  try {
    for (let i = 0, due = performance.now(); i < frames; i++) {
      notice("progress", "Recording a turn", memory.name, { progress: i / frames, cancel });
      const image = await still(app.painter, orbit(view, (2 * Math.PI * i) / frames, 0), size);
      await until(due);
      if (isCancelled) return;
      context.putImageData(image, 0, 0);
      due = Math.max(due, performance.now() - 1000 / RATE) + 1000 / RATE;
    }
  } finally {
    dismiss();
    recorder.stop();
  }
  await ended;
  save(new Blob(parts, { type: kind }), fileName(memory.name, kind.includes("webm") ? "webm" : "mp4"));
}
