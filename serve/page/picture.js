// The picture, and the statistics over it.

export class Picture {
  constructor(canvas, overlay) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d", { alpha: false });
    this.overlay = overlay;
    this.times = [];
    this.missed = 0;
    this.latency = null;
  }

  show(frame) {
    const { width, height, pixels } = frame;
    if (this.canvas.width !== width || this.canvas.height !== height || !this.image) {
      Object.assign(this.canvas, { width, height });
      this.image = this.context.createImageData(width, height);
      this.words = new Uint32Array(this.image.data.buffer);
    }
    const { words } = this;
    for (let i = 0, at = 0; i < words.length; i++, at += 3)
      words[i] = 0xff000000 | (pixels[at + 2] << 16) | (pixels[at + 1] << 8) | pixels[at]; // every browser is little-endian
    this.context.putImageData(this.image, 0, 0);
    this.canvas.classList.toggle("pixels", this.canvas.clientWidth > 1.9 * width);
    const now = performance.now();
    if (this.newest && frame.sequence > this.newest.sequence + 1) this.missed += frame.sequence - this.newest.sequence - 1;
    this.newest = frame;
    this.times = [...this.times.filter((time) => now - time < 2000), now];
    if (frame.requested) this.latency = now - frame.requested;
  }

  // Frames per second while frames arrive; 0 when they have stopped.
  rate() {
    const now = performance.now();
    const recent = this.times.filter((time) => now - time < 2000);
    return recent.length < 2 ? 0 : ((recent.length - 1) * 1000) / (recent[recent.length - 1] - recent[0]);
  }

  showStatistics() {
    const frame = this.newest;
    if (!frame) return;
    const rows = [
      ["frames per second", this.rate() ? this.rate().toFixed(1) : "idle"],
      ["latency", this.latency === null ? "–" : `${this.latency.toFixed(0)} ms`],
      ["render time", `${(frame.seconds * 1000).toFixed(1)} ms`],
      ["cycles per pixel", frame.cycles === null ? "no clock" : (frame.cycles / frame.rays).toFixed(2)],
      ["words per ray", frame.words === null ? "not counted" : (frame.words / frame.rays).toFixed(2)],
      ["picture", `${frame.width} × ${frame.height}`],
      ["frame", frame.sequence.toLocaleString() + (this.missed ? ` (${this.missed} missed)` : "")],
    ];
    this.overlay.replaceChildren(...rows.flatMap(([name, value]) => {
      const [term, figure] = [document.createElement("dt"), document.createElement("dd")];
      term.textContent = name;
      figure.textContent = value;
      return [term, figure];
    }));
  }

  save(name) {
    this.canvas.toBlob((blob) => {
      const link = document.createElement("a");
      link.href = URL.createObjectURL(blob);
      link.download = `${name.replace(/[^\w.-]+/g, "_")}.png`;
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 1000);
    }, "image/png");
  }
}
