// Where the page finds what `make site` puts beside it.

declare module "*/three/three.core.js" {
  export * from "three";
}
declare module "*/voxrt/voxrt.js" {
  export * from "voxrt/voxrt.js";
}
declare module "*/voxrt/scene.js" {
  export * from "voxrt/scene.js";
}
declare module "*/voxrt/hardware.js" {
  export * from "voxrt/hardware.js";
}
