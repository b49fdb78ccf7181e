// Links to a scene of the server and a view of it, in the part of the address after "#", beside the token.

import { cameraText, readCamera } from "./camera_text.js";
import { copyAddress } from "./copy_address.js";
import { $ } from "./elements.js";
import { notice } from "./notices.js";
/** @import { App } from "./app.js" @import { Placed } from "./camera_text.js" @import { State } from "./protocol.js" */

export class SceneLink {
  /** @type {{ scene: string, camera: Placed | null } | null} what the address names, until it is shown */ #wanted =
    null;
  #isRequested = false;

  /** @param {App} app */ constructor(app) {
    this.app = app;
    const fields = new URLSearchParams(location.hash.slice(1));
    const [scene, camera] = [fields.get("scene"), fields.get("camera")];
    if (scene !== null) this.#wanted = { scene, camera: readCamera(camera) };
    if (camera !== null && !this.#wanted?.camera)
      notice("error", "The view of this link cannot be shown", "its camera is damaged");
    $("copy").onclick = () => this.#copy();
    addEventListener("hashchange", () => location.reload()); // another link in the same tab
  }

  /** Show what the address names as soon as this viewer has control. @param {State} state */
  show({ scene }) {
    $("copy").hidden = !this.app.connection.hello?.scenes.includes(scene.name); // others cannot open an upload
    if (!this.#wanted || !this.app.hasControl()) return;
    const { scene: name, camera } = this.#wanted;
    if (scene.name === name) {
      this.#wanted = null;
      if (camera) this.app.change((now) => ({ ...now, ...camera }));
    } else if (!this.#isRequested) {
      this.#isRequested = true;
      this.app.scenes.request(name);
    }
  }

  async #copy() {
    const [pose, { scene }] = [this.app.view(), this.app.state()];
    if (!pose) return;
    const fields = new URLSearchParams(location.hash.slice(1));
    fields.set("scene", scene.name);
    fields.set("camera", cameraText(pose));
    await copyAddress(`#${fields}`);
  }
}
