// Where the page finds what `make site` puts beside it: the loaders of three.js, and the npm package.

declare module "*/three/three.core.js" { export * from "three"; }
declare module "*/libs/meshopt_decoder.module.js" { export * from "three/addons/libs/meshopt_decoder.module.js"; }
declare module "*/loaders/GLTFLoader.js" { export * from "three/addons/loaders/GLTFLoader.js"; }
declare module "*/loaders/MTLLoader.js" { export * from "three/addons/loaders/MTLLoader.js"; }
declare module "*/loaders/OBJLoader.js" { export * from "three/addons/loaders/OBJLoader.js"; }
declare module "*/loaders/PLYLoader.js" { export * from "three/addons/loaders/PLYLoader.js"; }
declare module "*/loaders/STLLoader.js" { export * from "three/addons/loaders/STLLoader.js"; }
declare module "*/loaders/USDLoader.js" { export * from "three/addons/loaders/USDLoader.js"; }
declare module "*/voxrt/hardware.js" { export * from "voxrt/hardware.js"; }
declare module "*/voxrt/opacity.js" { export * from "voxrt/opacity.js"; }
declare module "*/voxrt/scene.js" { export * from "voxrt/scene.js"; }
declare module "*/voxrt/voxrt.js" { export * from "voxrt/voxrt.js"; }
declare module "*/voxrt/warnings.js" { export * from "voxrt/warnings.js"; }
declare module "*/voxrt/words.js" { export * from "voxrt/words.js"; }
declare module "*/voxrt/world.js" { export * from "voxrt/world.js"; }

// What web/make_site.py puts into voxrt-view.js: a script as text, a module in zlib's bytes.
declare module "*.txt" { const text: string; export default text; }
declare module "*.zlib" { const bytes: Uint8Array<ArrayBuffer>; export default bytes; }

// What web/make_site.py writes for offline.js.
declare module "*/offline_files.js" { export const version: string; export const files: string[]; }

// @types/three leaves these classes out.
declare module "*/loaders/usd/USDAParser.js" { export const USDAParser: new () => import("./page/usd/three_private.js").TextParser; }
declare module "*/loaders/usd/USDCParser.js" { export const USDCParser: new () => import("./page/usd/three_private.js").CrateParser; }
declare module "*/loaders/usd/USDComposer.js" { export const USDComposer: new () => import("./page/usd/three_private.js").Composer; }
