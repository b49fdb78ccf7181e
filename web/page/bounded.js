// Bytes of a stream that may be longer than is good for the page: of another server, or compressed.

/** The bytes of a stream; null where there are more than `most`, which are not read to their end. @param
 * {ReadableStream<Uint8Array<ArrayBuffer>>} stream @param {number} most bytes */
export async function boundedBytes(stream, most) {
  /** @type {Uint8Array<ArrayBuffer>[]} */ const parts = [];
  let length = 0;
  for (const reader = stream.getReader(); ; ) {
    const { value } = await reader.read();
    if (!value) return new Uint8Array(await new Blob(parts).arrayBuffer());
    length += value.length;
    if (length > most) {
      reader.cancel().catch(() => {});
      return null;
    }
    parts.push(value);
  }
}
