// The static page: dropped files and examples become a memory in one worker, and pictures of it in several.

import { BandPicture, coloursOf } from "./band_picture.js";
import { BuildNotice } from "./build_notice.js";
import { Builder } from "./builder.js";
import { pixelDirection } from "./camera.js";
import { $ } from "./elements.js";
import { Figures } from "./figures.js";
import { firstView, limitOf } from "./first_view.js";
import { FrameRequests } from "./frame_requests.js";
import { Inspector } from "./inspector.js";
import { Light } from "./light.js";
import { FIRST_LOOK, nextLook, shadingOf } from "./looks.js";
import { boundsOf, worldOf } from "./memory.js";
import { MemoryPanel } from "./memory_panel.js";
import { focus } from "./navigation.js";
import { dismiss, notice } from "./notices.js";
import { Painter } from "./painter.js";
import { scale } from "./vectors.js";
import { Viewpoint } from "./viewpoint.js";
import { Views } from "./views.js";
/** @import { BandFrame } from "./band_picture.js" @import { Pose, Size } from "./camera.js" */
/** @import { Look } from "./light.js" */
/** @import { Memory, Shown } from "./memory.js" @import { Source } from "./sources.js" */
/** @import { Move } from "./viewpoint.js" */

/** What `make site` has put together. `boards`: the words that each holds; `designs`: the boards that have
 * bitstreams. @typedef {{ boards: Record<string, number>, designs: string[], examples: Record<string, { title:
 * string, files: string[] }> }} Site */

export class App {
  /** @type {Shown | null} */ #memory = null;
  #poseDepth = 7; // levels of the memory to which the pose belongs
  /** @type {Source | null} */ source = null;
  /** @type {{ frame: BandFrame, samples: number } | null} the picture */ newest = null;
  /** @type {{ settle: () => Promise<void>, memoryChanged: () => void } | null} */ editing = null;
  /** @type {{ end: () => void } | null} */ walker = null;
  /** @type {Look} */ #look = FIRST_LOOK;

  /** @param {WebAssembly.Module} module voxrt.wasm @param {Site} site */ constructor(module, site) {
    this.picture = new BandPicture($("picture"));
    this.figures = new Figures($("figures"));
    this.painter = new Painter(module);
    this.builder = new Builder(module);
    this.frames = new FrameRequests(this.painter, $("stage"));
    this.viewpoint = new Viewpoint(this.frames);
    this.light = new Light(this);
    this.light.hello(this.painter.hello);
    this.inspector = new Inspector(this);
    this.views = new Views(this);
    this.panel = new MemoryPanel(this, module, site);
    this.painter.on("trouble", (problem) => notice("error", "There are no frames", problem));
    this.painter.on("frame", (bands) => {
      const samples = this.frames.receive(bands);
      this.picture.showBands(bands, samples);
      this.newest = { frame: bands, samples };
      this.figures.add(bands, samples);
      const shownCamera = () => this.frames.registers(/** @type {Pose} */ (this.view()), this.#shownSize());
      const colours = () => coloursOf(bands);
      const readable = { newest: bands, colours, view: () => this.view(), shownCamera };
      Object.assign(window, { voxrt: readable }); // scripts may read the picture
    });
  }

  /** The memory that is shown, once there is one. */
  memory = () => this.#memory;

  /** The same, with all edits. */
  async settled() {
    await this.editing?.settle();
    return this.#memory;
  }

  #shown() {
    if (!this.#memory) throw new Error("no memory is shown");
    return this.#memory;
  }

  view = () => this.viewpoint.pose;
  device = () => this.painter.hello.device;
  state = () => ({ view: this.#look, scene: { depth: this.#memory?.depth ?? 1 } });
  size = () => this.frames.size;
  #shownSize = () => [$("picture").width, $("picture").height];
  side = () => 2 ** this.#shown().depth;
  bounds = () => this.#shown().bounds;
  limit = () => limitOf(this.#shown());
  /** Whether voxels change pixels of others. */
  isLit = () => this.#shading().light !== null || this.#shading().bounces > 0;
  #shading = () => shadingOf(this.#shown(), this.#look);

  /** How hits are coloured, without light and mirrors. */
  plainShading = () => ({ ...this.#shading(), mirrors: [], light: null, bounces: 0 });

  /** @param {Move} how */ change(how) {
    this.inspector.clear();
    this.viewpoint.change(how);
  }

  /** @param {Move} how */ glide(how) {
    this.walker?.end();
    this.inspector.clear();
    this.viewpoint.glide(how);
  }

  /** @param {Partial<Look>} fields */ set(fields) {
    this.#look = { ...this.#look, ...fields };
    this.painter.shade(this.#shading());
    this.#showLook();
    this.frames.change();
  }

  /** Give the workers other words of the same voxels. @param {Uint32Array} words */ async showWords(words) {
    await this.painter.load({ ...this.#shown(), words }, this.#shading());
    this.frames.change();
  }

  /** Pictures show this memory already. @param {Shown} memory */ revise(memory) {
    const { materials } = this.#shown();
    this.#memory = memory;
    if (materials !== memory.materials) this.painter.shade(this.#shading());
    this.panel.show(memory);
  }

  #showLook() {
    this.light.show(this.state());
    $("picture").style.backgroundColor = `rgb(${this.#look.background.join()})`;
  }

  /** Build the memory of a source at the depth of the slider, and show it. @param {Source} source */
  async open(source) {
    this.source = source;
    await this.build(true);
  }

  /** Build the memory of the current source anew. @param {boolean} first whether it is another one than before */
  async build(first = false) {
    const { source } = this;
    if (!source) return;
    const announced = new BuildNotice(source.files[0].name, () => this.builder.cancel());
    try {
      const built = await this.builder.build(source.files, this.panel.options(), (stage) => announced.enter(stage));
      if (source !== this.source) return;
      announced.end();
      await this.#show(built, first);
      dismiss();
    } catch (error) {
      const { message } = /** @type {Error} */ (error);
      if (message === "cancelled") return;
      const isRead = announced.stage !== null && announced.stage.text !== "Reading";
      notice("error", isRead ? "The model cannot be voxelized" : "The model cannot be shown", message);
    } finally {
      announced.end();
    }
  }

  /** @param {Memory} built @param {boolean} first */ async #show(built, first) {
    const old = this.#memory;
    /** @type {Shown} */ const memory = { ...built, voxels: [], bounds: worldOf(built.depth) };
    this.#look = nextLook(this.#look, memory, old, first);
    this.#memory = memory;
    this.inspector.clear();
    this.editing?.memoryChanged();
    await this.painter.load(memory, this.#shading());
    const { voxels, outline } = await this.painter.census();
    if (this.#memory !== memory) return;
    Object.assign(memory, { voxels, bounds: boundsOf(outline) ?? memory.bounds });
    const pose = this.view();
    this.viewpoint.reset(pose && !first ? rescaled(pose, built.depth - this.#poseDepth) : this.firstView());
    this.#poseDepth = built.depth;
    $("stage").classList.remove("empty");
    this.#showLook();
    this.panel.show(memory);
    this.frames.change();
    $("stage").dataset.scene = `${built.name} ${built.depth}`;
  }

  firstView = () => firstView(this.#shown(), this.size());

  /** Follow the ray of a pixel. @param {Size} pixel column and row */
  async #follow([column, row]) {
    const size = this.#shownSize();
    const registers = this.frames.registers(/** @type {Pose} */ (this.view()), size);
    const followed = await this.painter.follow(registers.position, pixelDirection(registers, size, column, row));
    return { ...followed, registers, size, pixel: [column, row] };
  }

  /** Show the way of the ray at a place of the page. @param {number} x @param {number} y */
  async followAt(x, y) {
    if (!this.view()) return;
    const pixel = this.picture.pixelAt(x, y);
    if (pixel.some((part, axis) => part < 0 || part >= this.#shownSize()[axis])) return;
    try {
      this.inspector.show(await this.#follow(pixel));
    } catch (error) {
      notice("error", "The ray cannot be followed", /** @type {Error} */ (error).message);
    }
  }

  /** The voxel at a place of the page becomes the target. @param {number} x @param {number} y */
  async focusAt(x, y) {
    if (!this.view()) return;
    const { cell } = await this.#follow(this.picture.pixelAt(x, y));
    const middle = cell?.map((value) => value + 0.5);
    if (middle) this.glide((now) => focus(now, middle, this.limit()));
  }
}

/** The same view of a world of more or fewer levels. @param {Pose} pose @param {number} levels */
function rescaled(pose, levels) {
  const factor = 2 ** levels;
  return { ...pose, eye: scale(pose.eye, factor), distance: pose.distance * factor };
}
