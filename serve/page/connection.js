// The line to the frame server: connects, reconnects by itself, numbers requests and hands out what comes.

export const PROTOCOL = 1;
const HEADER = 56;
const RETRY = { first: 500, most: 5000 };

const counted = (count) => (count === 0xffffffffffffffffn ? null : Number(count));

export class Link extends EventTarget {
  constructor() {
    super();
    this.hello = null;
    this.pending = new Map(); // request -> {resolve, reject, progress}
    this.sent = new Map(); // request -> when, of view changes whose frame has not come
    this.number = 0;
    this.retry = RETRY.first;
    this.connect();
  }

  connect() {
    const token = new URLSearchParams(location.hash.slice(1)).get("token");
    const query = token ? `?token=${encodeURIComponent(token)}` : "";
    this.socket = new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/v${PROTOCOL}${query}`);
    this.socket.binaryType = "arraybuffer";
    this.socket.onmessage = ({ data }) => (typeof data === "string" ? this.hear(JSON.parse(data)) : this.see(data));
    this.socket.onclose = (event) => this.lose(event);
  }

  get live() { return this.hello !== null; }

  lose({ code, reason }) {
    const was = this.live;
    this.hello = null;
    this.sent.clear();
    for (const { reject } of this.pending.values()) reject(new Error("the board went away"));
    this.pending.clear();
    this.tell("away", { was, code, reason, retry: this.retry });
    setTimeout(() => this.connect(), this.retry);
    this.retry = Math.min(this.retry * 1.6, RETRY.most);
  }

  tell(type, detail) { this.dispatchEvent(new CustomEvent(type, { detail })); }

  hear(message) {
    switch (message.type) {
      case "hello":
        if (message.protocol !== PROTOCOL) { location.reload(); return; }
        this.hello = message;
        this.retry = RETRY.first;
        this.tell("hello", message);
        break;
      case "state": this.state = message; this.tell("state", message); break;
      case "progress": case "received": this.pending.get(message.request)?.progress?.(message); break;
      case "refused": case "done": case "ready": {
        const waiting = this.pending.get(message.request);
        this.pending.delete(message.request);
        if (message.type === "refused") {
          this.sent.delete(message.request);
          if (waiting) waiting.reject(new Error(message.problem)); else this.tell("refused", message);
        } else waiting?.resolve(message);
      }
    }
  }

  see(data) {
    const view = new DataView(data);
    const bytes = new Uint8Array(data, 0, 4);
    if (data.byteLength < HEADER || String.fromCharCode(...bytes) !== "VXFR") return;
    const u32 = (at) => view.getUint32(at, true);
    const frame = {
      width: view.getUint16(6, true), height: view.getUint16(8, true), sequence: u32(12), length: u32(16), scene: u32(20),
      viewer: u32(24), request: u32(28), rays: u32(32), seconds: u32(36) / 1e6,
      cycles: counted(view.getBigUint64(40, true)), words: counted(view.getBigUint64(48, true)),
    };
    const header = view.getUint16(4, true);
    if (frame.length !== data.byteLength - header || frame.length !== 3 * frame.width * frame.height) return;
    frame.pixels = new Uint8Array(data, header);
    if (frame.viewer === this.hello?.viewer) {
      for (const [request, when] of this.sent) {
        if (request > frame.request) continue;
        this.sent.delete(request);
        if (request === frame.request) frame.asked = when;
      }
    }
    this.tell("frame", frame);
  }

  // A change of the view; its answer is a frame.
  change(fields) {
    if (!this.live) return;
    this.sent.set(this.post("view", fields), performance.now());
  }

  ask(type, fields = {}, progress = null) {
    if (!this.live) return Promise.reject(new Error("the board is away"));
    const number = this.post(type, fields);
    return new Promise((resolve, reject) => this.pending.set(number, { resolve, reject, progress, number }));
  }

  post(type, fields) {
    this.number += 1;
    this.socket.send(JSON.stringify({ type, request: this.number, ...fields }));
    return this.number;
  }
}
