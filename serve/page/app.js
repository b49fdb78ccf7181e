// The page of the server: it joins connection, picture, navigation and panels. While this viewer has control, the page owns
// the view and sends it to the server. While another viewer has control, the page follows the view of the server.

import { Advanced } from "./advanced.js";
import { fromRegisters, pixelDirection, toRegisters } from "./camera.js";
import { Connection } from "./connection.js";
import { $, all, isPressed } from "./elements.js";
import { Figures } from "./figures.js";
import { FrameRequests } from "./frame_requests.js";
import { Light } from "./light.js";
import { focus } from "./navigation.js";
import { dismiss, hideAway, notice, showAway } from "./notices.js";
import { Picture } from "./picture.js";
import { Player } from "./player.js";
import { SceneLink } from "./scene_link.js";
import { Scenes } from "./scenes.js";
import { add, scale } from "./vectors.js";
import { Viewpoint } from "./viewpoint.js";
import { Views } from "./views.js";
/** @import { Box, Registers, Size } from "./camera.js" @import { Away } from "./connection.js" */
/** @import { Frame, Hello, State, View } from "./protocol.js" @import { Move } from "./viewpoint.js" */
/** @import { EditTools } from "./edit_tools.js" @import { Walker } from "./walker.js" */

const CONTROLS = "#panel :is(button, input, select), #empty button, #frame, #player :is(button, input), #pad button";
const ALWAYS = ["help", "copy"]; // work without control

export class App {
  /** @type {number | null} the scene to which the view belongs */ #scene = null;
  /** @type {EditTools | null} */ editing = null;
  /** @type {Walker | null} */ walker = null;
  #hadControl = false;
  #hasRequested = false; // control, since nobody has it
  /** @type {Partial<View>} fields of the view that the state of the server does not have yet */ #unconfirmed = {};

  constructor() {
    this.connection = new Connection();
    this.picture = new Picture($("picture"));
    this.figures = new Figures($("figures"));
    this.frames = new FrameRequests(this.connection, $("stage"));
    this.viewpoint = new Viewpoint(this.frames);
    this.player = new Player(this);
    this.scenes = new Scenes(this);
    this.views = new Views(this);
    this.light = new Light(this);
    this.advanced = new Advanced(this);
    this.link = new SceneLink(this);
    this.connection.on("hello", (hello) => this.#greet(hello));
    this.connection.on("disconnected", (away) => this.#leave(away));
    this.connection.on("state", (state) => this.#show(state));
    this.connection.on("frame", (frame) => this.#showFrame(frame));
    this.connection.on("refused", ({ problem }) => {
      this.#unconfirmed = {};
      notice("error", "The request was refused", problem);
    });
  }

  /** The state of the server, which has told it when it can change. */
  state = () => /** @type {State} */ (this.connection.state);
  device = () => this.frames.device;

  hasControl() {
    const { hello, state } = this.connection;
    return hello !== null && state?.controller === hello.viewer;
  }

  view = () => this.viewpoint.pose;
  size = () => this.frames.size;
  side = () => 2 ** this.state().scene.depth;

  /** @returns {Box} what is solid */ bounds = () =>
    this.state().scene.bounds ?? [[0, 0, 0], Array(3).fill(this.side())];

  limit = () => Math.min(8 * this.side() + 512, this.device().position_limit / 16 - 1);

  /** @param {Move} how */ change(how) {
    if (this.hasControl()) this.viewpoint.change(how);
  }

  /** @param {Move} how */ glide(how) {
    if (!this.hasControl()) return;
    this.walker?.end();
    this.viewpoint.glide(how);
  }

  /** @param {Partial<View>} fields */ set(fields) {
    if (!this.hasControl()) return;
    Object.assign(this.#unconfirmed, fields);
    Object.assign(this.state().view, fields); // the next change starts from it
    this.frames.change(fields);
  }

  waits = () => this.connection.sent.size > 0 || this.frames.changed;

  /** @param {Size | null} size null for that of the stage */ fixSize(size) {
    this.frames.resolution.fixed = size;
  }

  coarsen() {
    if (this.viewpoint.pose) this.frames.coarsen(this.viewpoint.pose);
  }

  /** Whether the camera can move. */
  isReady = () => this.hasControl() && this.viewpoint.pose !== null && this.#scene !== 0;

  /** The first view of the scene. */
  firstView() {
    const { camera, size } = this.state().scene;
    return this.#poseOf(camera, size);
  }

  /** The ray through a place of the page. @param {number} x @param {number} y */
  rayAt(x, y) {
    const pose = this.view();
    if (!pose) return null;
    const size = [$("picture").width, $("picture").height];
    const [column, row] = this.picture.pixelAt(x, y);
    const registers = toRegisters(pose, size);
    return { origin: registers.position, direction: pixelDirection(registers, size, column, row) };
  }

  /** The voxel under a place of the page becomes the target. @param {number} x @param {number} y */
  async focusAt(x, y) {
    const isFree = this.hasControl() && !this.editing?.active && !isPressed($("walk"));
    const ray = isFree ? this.rayAt(x, y) : null;
    if (!ray) return;
    try {
      const { hit } = await this.connection.request("ray", ray);
      if (hit) this.glide((now) => focus(now, hit.point, this.limit()));
    } catch (error) {
      notice("error", "There is no point to focus", /** @type {Error} */ (error).message);
    }
  }

  showWaiting() {
    const waiting = this.hasControl() ? this.frames.waiting : null;
    $("rendering").hidden = !waiting;
    if (!waiting) return;
    const left = Math.ceil(waiting.seconds - (performance.now() - waiting.since) / 1000);
    const text = left > 0 ? `rendering, about ${left} s` : "rendering, a moment more";
    if ($("rendering").textContent !== text) $("rendering").textContent = text;
  }

  /** @param {Hello} hello */ #greet(hello) {
    $("connection").dataset.state = "connected";
    $("connection").textContent = hello.device.name;
    hideAway();
    dismiss();
    this.#hadControl = false;
    for (const panel of [this.scenes, this.light, this.advanced]) panel.hello(hello);
  }

  /** @param {Away} away */ #leave(away) {
    $("connection").dataset.state = "disconnected";
    $("connection").textContent = "not connected";
    $("control").textContent = "";
    $("take").hidden = $("release").hidden = true;
    dismiss();
    showAway(away, away.retry / 1000);
  }

  /** @param {State} state */ #show(state) {
    const mine = this.hasControl();
    const { connection } = this;
    const { scene, view, trouble, controller } = state;
    this.#confirm(view, mine);
    if (!mine || trouble) connection.sent.clear(); // no frame will answer these
    if (controller === null && !this.#hasRequested) connection.request("take").catch(() => {});
    this.#hasRequested = controller === null;
    this.#showControl(state, mine);
    const another = this.#scene !== scene.number;
    if (another || !mine) this.walker?.end();
    this.#scene = scene.number;
    if (another || !mine || !this.#hadControl || !this.viewpoint.pose) {
      this.viewpoint.reset(another && mine ? this.firstView() : this.#poseOf(view.camera, view.size));
      if (mine) this.frames.change();
      else if (this.#hadControl) this.frames.showBusy(false);
    }
    this.#hadControl = mine;
    $("scene").textContent = scene.number === 0 ? "" : scene.name;
    $("details").textContent =
      scene.number === 0 ? "" : `${2 ** scene.depth}³ voxels · ${scene.words.toLocaleString()} words`;
    $("picture").style.backgroundColor = `rgb(${view.background.join()})`;
    for (const panel of [this.scenes, this.player, this.light, this.advanced, this.link, this.editing])
      panel?.show(state);
    $("connection").dataset.state = trouble ? "disconnected" : "connected";
    $("connection").textContent = trouble ? "no frames" : this.device().name;
    if (trouble) notice("error", "There are no frames", trouble);
  }

  /** Forget the fields that the server has; keep the others in its view. @param {View} view @param {boolean} mine */
  #confirm(view, mine) {
    const missing = Object.entries(this.#unconfirmed).filter(
      ([name, value]) =>
        JSON.stringify(Object.entries(view).find(([known]) => known === name)?.[1]) !== JSON.stringify(value),
    );
    this.#unconfirmed = mine ? Object.fromEntries(missing) : {};
    Object.assign(view, this.#unconfirmed);
  }

  /** @param {State} state @param {boolean} mine */ #showControl({ controller, waiting, viewers }, mine) {
    $("control").dataset.state = mine ? "mine" : "";
    const others = viewers > 1 ? `you have control · ${viewers} viewers` : "";
    const owner = controller === null ? "nobody has control" : `viewer ${controller} has control`;
    $("control").textContent = !mine ? owner : waiting.length ? `viewer ${waiting[0]} asks for control` : others;
    for (const made of all(CONTROLS)) if (!ALWAYS.includes(made.id)) Object.assign(made, { disabled: !mine });
    const requested = waiting.some((viewer) => viewer === this.connection.hello?.viewer);
    $("take").hidden = mine;
    $("take").disabled = requested;
    $("take").textContent = requested ? "Control requested" : "Take control";
    $("release").hidden = !mine || waiting.length === 0;
  }

  /** @param {Frame & { pixels: Uint8Array }} frame */ #showFrame(frame) {
    const samples = this.frames.receive(frame);
    this.picture.show(frame, samples, this.frames.resolution.fixed !== null);
    this.figures.add(frame, samples);
  }

  /** The pose of registers, with the middle of the scene as target. @param {Registers} camera @param {Size} size */
  #poseOf(camera, size) {
    const [low, high] = this.bounds();
    return fromRegisters(camera, size, scale(add(low, high), 0.5), this.frames.size);
  }
}
