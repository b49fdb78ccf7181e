// The connection to the frame server: it reconnects by itself, numbers the requests and dispatches what arrives.

import { Events } from "./events.js";
import { isPart, PART_HEADER, PROTOCOL, readFrame } from "./protocol.js";
import { askForReason } from "./refusal.js";
/** @import { Registers, Size } from "./camera.js" */
/** @import { Frame, Hello, Progress, State, View } from "./protocol.js" @import { Refusal } from "./refusal.js" */
/** @import { Vector } from "./vectors.js" */

const RETRY = { first: 500, longest: 5000 }; // milliseconds

/** @typedef {Refusal & { retry: number }} Away */
/** @typedef {Progress & { type: string, bytes: number }} Report */

/** An octree: Base64 of its words. @typedef {{ depth: number, words: string }} Solid */

/** What answers hold, each some of it. @typedef {{ request: number, upload: number, scene: { name: string }, hit: { point:
 * Vector, voxel: Vector, material: number, face: number | null } | null, files: { name: string, size: number }[], part:
 * Uint8Array<ArrayBuffer>, edit: { blocks: number, words: number, undo: number, redo: number, materials: number },
 * solid: Solid, materials: [string, string][], registers: Record<string, number>, counters: Record<string, number> }} Answer */

/** @typedef {{ resolve: (answer: Answer) => void, reject: (error: Error) => void, progress?: ((report: Report) =>
 * void) | null }} Pending a request that waits for its answer */

/** @typedef {{ type: "hello" } & Hello} HelloMessage */
/** @typedef {{ type: "state" } & State} StateMessage */
/** @typedef {{ type: "progress" | "received", request: number } & Report} ReportMessage */
/** @typedef {{ type: "refused", request: number, problem: string }} RefusedMessage */
/** @typedef {{ type: "done" | "ready" } & Answer} AnswerMessage */

/** @extends {Events<{ hello: Hello, state: State, frame: Frame & { pixels: Uint8Array }, disconnected: Away,
 * refused: RefusedMessage }>} */
export class Connection extends Events {
  /** @type {Hello | null} */ hello = null;
  /** @type {State | null} */ state = null;
  /** @type {Map<number, Pending>} by the number of the request */ pending = new Map();
  /** @type {Map<number, number>} when view changes were sent whose frame has not arrived, by request */
  sent = new Map();
  #number = 0;
  #part = 0; // the request that a part answers
  #retry = RETRY.first;
  /** @type {ReturnType<typeof setTimeout> | undefined} */ #timer;

  constructor() {
    super();
    this.socket = this.#connect();
    // A page that the browser keeps for "back" must not keep its control.
    addEventListener("pagehide", () => this.socket.close());
    addEventListener("pageshow", ({ persisted }) => {
      if (persisted) this.connectNow();
    });
  }

  get token() {
    return new URLSearchParams(location.hash.slice(1)).get("token");
  }

  /** Connect with another token; the address keeps it. @param {string} token */
  useToken(token) {
    history.replaceState(null, "", `#${new URLSearchParams({ token })}`);
    this.connectNow();
  }

  connectNow() {
    clearTimeout(this.#timer);
    this.#retry = RETRY.first;
    if (this.socket.readyState > WebSocket.OPEN) this.socket = this.#connect();
  }

  #connect() {
    const query = this.token ? `?${new URLSearchParams({ token: this.token })}` : "";
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    const socket = new WebSocket(`${scheme}://${location.host}/v${PROTOCOL}${query}`);
    socket.binaryType = "arraybuffer";
    socket.onmessage = ({ data }) =>
      typeof data === "string" ? this.#receiveMessage(JSON.parse(data)) : this.#receiveBinary(data);
    socket.onclose = (event) => this.#handleClose(event);
    return socket;
  }

  get connected() {
    return this.hello !== null;
  }

  /** @param {CloseEvent} event */ async #handleClose({ code }) {
    const wasConnected = this.connected;
    this.hello = null;
    this.sent.clear();
    for (const { reject } of this.pending.values()) reject(new Error("the connection to the server was lost"));
    this.pending.clear();
    const { socket } = this;
    const refusal = await this.#refusal(code, wasConnected);
    if (socket !== this.socket) return; // somebody has connected meanwhile
    this.emit("disconnected", { ...refusal, retry: this.#retry });
    this.#timer = setTimeout(() => {
      this.socket = this.#connect();
    }, this.#retry);
    this.#retry = Math.min(this.#retry * 1.6, RETRY.longest);
  }

  /** Why the connection is lost. @param {number} code @param {boolean} wasConnected @returns {Promise<Refusal>} */
  async #refusal(code, wasConnected) {
    if (code === 1013) return { reason: "full" };
    if (wasConnected) return { reason: "lost" };
    return askForReason(`/v${PROTOCOL}`, this.token ? { token: this.token } : {});
  }

  /** @param {HelloMessage | StateMessage | ReportMessage | RefusedMessage | AnswerMessage} message */
  #receiveMessage(message) {
    switch (message.type) {
      case "hello":
        if (message.protocol !== PROTOCOL) {
          location.reload();
          return;
        }
        this.hello = message;
        this.#retry = RETRY.first;
        this.emit("hello", message);
        break;
      case "state":
        this.state = message;
        this.emit("state", message);
        break;
      case "progress":
      case "received":
        this.pending.get(message.request)?.progress?.(message);
        break;
      case "refused": {
        const waiting = this.pending.get(message.request);
        this.pending.delete(message.request);
        this.sent.delete(message.request);
        if (waiting) waiting.reject(new Error(message.problem));
        else this.emit("refused", message);
        break;
      }
      case "done":
      case "ready": {
        const waiting = this.pending.get(message.request);
        this.pending.delete(message.request);
        waiting?.resolve(message);
      }
    }
  }

  /** @param {ArrayBuffer} data */ #receiveBinary(data) {
    if (!isPart(data)) {
      this.#receiveFrame(data);
      return;
    }
    const waiting = this.pending.get(this.#part);
    this.pending.delete(this.#part);
    const part = new Uint8Array(data, PART_HEADER);
    waiting?.resolve(/** @type {Answer} */ (/** @type {unknown} */ ({ part })));
  }

  /** A part of the files that were saved last; one at a time. @param {number} offset */ async part(offset) {
    const answer = this.request("part", { offset });
    this.#part = this.#number;
    return (await answer).part;
  }

  /** @param {ArrayBuffer} data */ #receiveFrame(data) {
    const frame = readFrame(data);
    if (!frame) return;
    if (frame.viewer === this.hello?.viewer) {
      for (const [request, time] of this.sent) {
        if (request > frame.request) continue;
        this.sent.delete(request);
        if (request === frame.request) frame.requested = time;
      }
    }
    this.emit("frame", frame);
  }

  /** Change the view; returns the number of the request. @param {Partial<View> & { camera: Registers, size: Size }}
   * fields */
  changeView(fields) {
    if (!this.connected) return 0;
    const number = this.#send("view", fields);
    this.sent.set(number, performance.now());
    return number;
  }

  /** Send a request; resolves with its answer, rejects with the reason of a refusal. @param {string} type @param
   * {object} [fields] @param {Pending["progress"]} [progress] */
  request(type, fields = {}, progress = null) {
    if (!this.connected) return Promise.reject(new Error("there is no connection to the server"));
    const number = this.#send(type, fields);
    return new Promise((resolve, reject) => this.pending.set(number, { resolve, reject, progress }));
  }

  /** @param {string} type @param {object} fields */ #send(type, fields) {
    this.#number += 1;
    this.socket.send(JSON.stringify({ type, request: this.#number, ...fields }));
    return this.#number;
  }
}
