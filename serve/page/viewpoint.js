// Where the camera stands, and how it goes elsewhere: at once or in a glide. Requests of frames follow it.

import { Glide } from "./glide.js";
/** @import { Pose } from "./camera.js" @import { Flight } from "./flight.js" */
/** @import { FrameRequests } from "./frame_requests.js" @import { Gestures } from "./gestures.js" */

/** @typedef {(now: Pose) => Pose} Move */

export class Viewpoint {
  /** @type {Pose | null} */ pose = null;
  #glide = new Glide();

  /** @param {FrameRequests} frames */ constructor(frames) {
    this.frames = frames;
  }

  /** @param {Move} how */ change(how) {
    if (!this.pose) return;
    this.#glide.stop();
    this.pose = how(this.pose);
    this.frames.change();
  }

  /** @param {Move} how */ glide(how) {
    if (!this.pose) return;
    this.#glide.start(this.pose, how(this.pose), this.frames.resolution.seconds(this.frames.size) > 1);
    this.frames.showBusy(true);
  }

  /** Forget the pose and what was not sent: another one counts now. @param {Pose} pose */
  reset(pose) {
    this.#glide.stop();
    this.frames.discard();
    this.pose = pose;
  }

  /** Called once per frame of the screen. Returns whether the view has changed. @param {{ gestures: Gestures,
   * flight: Pick<Flight, "active" | "step"> }} pilot */
  step({ gestures, flight }) {
    gestures.step();
    flight.step();
    if (!this.pose) return false;
    const gliding = this.#glide.step();
    if (gliding) {
      this.pose = gliding;
      this.frames.change();
    }
    const { changed } = this.frames;
    const rests = this.frames.step(this.pose, gestures.active || flight.active);
    this.frames.showBusy(!rests || gliding !== null);
    return changed;
  }
}
