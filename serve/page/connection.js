// The connection to the frame server: it reconnects by itself, numbers the requests and dispatches what arrives.

import { askForReason } from "./refusal.js";

export const PROTOCOL = 2;
const HEADER = 56;
const RETRY = { first: 500, longest: 5000 }; // milliseconds

const counter = (count) => (count === 0xffffffffffffffffn ? null : Number(count));

export class Connection extends EventTarget {
  constructor() {
    super();
    this.hello = null;
    this.pending = new Map(); // request -> {resolve, reject, progress}
    this.sent = new Map(); // request -> time of sending, for view changes whose frame has not arrived
    this.number = 0;
    this.retry = RETRY.first;
    this.connect();
    // A page that the browser keeps for "back" must not keep its control.
    addEventListener("pagehide", () => this.socket.close());
    addEventListener("pageshow", ({ persisted }) => {
      if (persisted) this.connectNow();
    });
  }

  get token() {
    return new URLSearchParams(location.hash.slice(1)).get("token");
  }

  // Connect with another token; the address keeps it.
  useToken(token) {
    history.replaceState(null, "", `#${new URLSearchParams({ token })}`);
    this.connectNow();
  }

  connectNow() {
    clearTimeout(this.timer);
    this.retry = RETRY.first;
    if (this.socket.readyState > WebSocket.OPEN) this.connect();
  }

  connect() {
    const query = this.token ? `?${new URLSearchParams({ token: this.token })}` : "";
    this.socket = new WebSocket(
      `${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/v${PROTOCOL}${query}`,
    );
    this.socket.binaryType = "arraybuffer";
    this.socket.onmessage = ({ data }) =>
      typeof data === "string" ? this.receiveMessage(JSON.parse(data)) : this.receiveFrame(data);
    this.socket.onclose = (event) => this.handleClose(event);
  }

  get connected() {
    return this.hello !== null;
  }

  async handleClose({ code }) {
    const wasConnected = this.connected;
    this.hello = null;
    this.sent.clear();
    for (const { reject } of this.pending.values()) reject(new Error("the connection to the server was lost"));
    this.pending.clear();
    const { socket } = this;
    const refusal =
      code === 1013
        ? { reason: "full" }
        : wasConnected
          ? { reason: "lost" }
          : await askForReason(`/v${PROTOCOL}`, this.token ? { token: this.token } : {});
    if (socket !== this.socket) return; // somebody has connected meanwhile
    this.emit("disconnected", { ...refusal, retry: this.retry });
    this.timer = setTimeout(() => this.connect(), this.retry);
    this.retry = Math.min(this.retry * 1.6, RETRY.longest);
  }

  emit(type, detail) {
    this.dispatchEvent(new CustomEvent(type, { detail }));
  }

  receiveMessage(message) {
    switch (message.type) {
      case "hello":
        if (message.protocol !== PROTOCOL) {
          location.reload();
          return;
        }
        this.hello = message;
        this.retry = RETRY.first;
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
      case "refused":
      case "done":
      case "ready": {
        const waiting = this.pending.get(message.request);
        this.pending.delete(message.request);
        if (message.type === "refused") {
          this.sent.delete(message.request);
          if (waiting) waiting.reject(new Error(message.problem));
          else this.emit("refused", message);
        } else waiting?.resolve(message);
      }
    }
  }

  receiveFrame(data) {
    const view = new DataView(data);
    const bytes = new Uint8Array(data, 0, 4);
    if (data.byteLength < HEADER || String.fromCharCode(...bytes) !== "VXFR") return;
    const u32 = (at) => view.getUint32(at, true);
    const frame = {
      width: view.getUint16(6, true),
      height: view.getUint16(8, true),
      sequence: u32(12),
      length: u32(16),
      scene: u32(20),
      viewer: u32(24),
      request: u32(28),
      rays: u32(32),
      seconds: u32(36) / 1e6,
      cycles: counter(view.getBigUint64(40, true)),
      words: counter(view.getBigUint64(48, true)),
    };
    const header = view.getUint16(4, true);
    if (frame.length !== data.byteLength - header || frame.length !== 3 * frame.width * frame.height) return;
    frame.pixels = new Uint8Array(data, header);
    if (frame.viewer === this.hello?.viewer) {
      for (const [request, time] of this.sent) {
        if (request > frame.request) continue;
        this.sent.delete(request);
        if (request === frame.request) frame.requested = time;
      }
    }
    this.emit("frame", frame);
  }

  // Change the view; a frame with this request follows. Returns the request's number.
  changeView(fields) {
    if (!this.connected) return 0;
    const number = this.send("view", fields);
    this.sent.set(number, performance.now());
    return number;
  }

  // Send a request; resolves with its answer, rejects with the reason of a refusal.
  request(type, fields = {}, progress = null) {
    if (!this.connected) return Promise.reject(new Error("there is no connection to the server"));
    const number = this.send(type, fields);
    return new Promise((resolve, reject) => this.pending.set(number, { resolve, reject, progress, number }));
  }

  send(type, fields) {
    this.number += 1;
    this.socket.send(JSON.stringify({ type, request: this.number, ...fields }));
    return this.number;
  }
}
