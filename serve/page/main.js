// The start of the page: its buttons, its keys, and what happens once per frame of the screen.

import { App } from "./app.js";
import { EditTools } from "./edit_tools.js";
import { $ } from "./elements.js";
import { frame } from "./navigation.js";
import { makePilot } from "./pilot.js";
import { ServedGround } from "./served_ground.js";
import { makeTools } from "./tools.js";
import { Walker } from "./walker.js";

const app = new App();
const { connection, viewpoint, views } = app;
const commands = {
  ...makeTools(),
  KeyF: () => app.glide((now) => frame(now, app.bounds(), app.size(), app.limit())),
  KeyR: () => app.glide(() => app.firstView()),
  KeyN: () => $("nonstop").click(),
  ...views.commands(),
};
const pilot = makePilot(app, $("picture"), commands, (x, y) => app.focusAt(x, y));
const walker = new Walker(app, pilot.flight, new ServedGround(app));
app.editing = new EditTools(app, pilot.gestures, commands, walker);

$("walk").onclick = () => walker.start();
$("frame").onclick = commands.KeyF;
$("reset").onclick = commands.KeyR;
$("take").onclick = () => connection.request("take").catch(() => {});
$("release").onclick = () => connection.request("release").catch(() => {});
$("retry").onclick = () => connection.connectNow();
$("save").onclick = () =>
  app.picture.save(`${connection.state?.scene.name ?? "voxrt"}-${app.figures.newest?.sequence ?? 0}`);
$("token-form").onsubmit = (event) => {
  event.preventDefault();
  connection.useToken(String(new FormData($("token-form")).get("token")));
};

function animate() {
  requestAnimationFrame(animate);
  if (!app.isReady()) return;
  app.player.step();
  if (viewpoint.step(pilot)) app.advanced.showCamera();
}
requestAnimationFrame(animate);
setInterval(() => {
  app.figures.show();
  app.showWaiting();
  app.advanced.readRegisters();
}, 250);
