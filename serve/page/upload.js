// The upload of a scene: the files are announced and sent in chunks, each with a CRC-32. Then the server reports its
// progress until the scene is loaded.

import { crc32 } from "./crc32.js";

const WINDOW = 8; // chunks that the server has not acknowledged

/** @import { Connection, Report } from "./connection.js" @import { OnProgress } from "./scenes.js" */

/** @param {number} upload @param {number} offset @param {Uint8Array} bytes */ function chunk(upload, offset, bytes) {
  const message = new Uint8Array(16 + bytes.length);
  const view = new DataView(message.buffer);
  message.set([0x56, 0x58, 0x43, 0x48]); // VXCH
  view.setUint32(4, upload, true);
  view.setUint32(8, offset, true);
  view.setUint32(12, crc32(bytes), true);
  message.set(bytes, 16);
  return message;
}

/** Resolves with what is known of the scene, rejects with the reason of the server, or when `signal` aborts. The caller then tells
 * the server. @param {Connection} connection @param {File[]} files @param {OnProgress} report @param {AbortSignal}
 * signal */
export async function uploadFiles(connection, files, report, signal) {
  const parts = await Promise.all(files.map(async (file) => new Uint8Array(await file.arrayBuffer())));
  const total = parts.reduce((sum, part) => sum + part.length, 0);
  if (!connection.hello) throw new Error("there is no connection to the server");
  const { upload: limit, chunk: step } = connection.hello.limits;
  if (total === 0) throw new Error("the file is empty");
  const [size, most] = [(total / 2 ** 20).toFixed(0), limit / 2 ** 20];
  if (total > limit) throw new Error(`${size} MB are more than the ${most} MB that the server accepts`);
  const data = new Uint8Array(total);
  let end = 0;
  for (const part of parts) {
    data.set(part, end);
    end += part.length;
  }

  let received = 0;
  let wake = () => {};
  /** @param {Report} message */ const progress = (message) => {
    if (message.type === "received") {
      received = message.bytes;
      report("send", received, total);
    } else report(message.stage, message.done, message.total);
    wake();
  };
  const announced = files.map((file, i) => ({ name: file.name, size: parts[i].length, crc32: crc32(parts[i]) }));
  const ready = await connection.request("upload", { files: announced });
  let failed = false;
  /** @type {ReturnType<Connection["request"]>} */
  const done = new Promise((resolve, reject) => connection.pending.set(ready.request, { resolve, reject, progress }));
  done.catch(() => {
    failed = true;
    wake();
  });
  signal.addEventListener("abort", () => connection.pending.get(ready.request)?.reject(new Error("cancelled")));
  for (let offset = 0; offset < total && !failed; offset += step) {
    while (offset - received >= WINDOW * step && !failed)
      await new Promise((resolve) => {
        wake = () => resolve(null);
      });
    if (!failed) connection.socket.send(chunk(ready.upload, offset, data.subarray(offset, offset + step)));
  }
  return (await done).scene;
}
