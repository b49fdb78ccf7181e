import type { Scene, Voxrt, Warning } from "./voxrt.js";

export interface Rules {
  /** What makes meshes one object. */
  groupOf?(mesh: object): unknown;
  nameOf?(mesh: object, group: unknown): string;
  /** Null for the default material; `colour` (sRGB) replaces that of the material. */
  materialOf?(material: object): {
    key: unknown; name: string; order?: number; colour?: number[]; mirror?: boolean; authored?: boolean;
  } | null;
}

/** The visible meshes below an object of three.js, at this moment. */
export function sceneOf(root: object, voxrt: Voxrt, rules?: Rules): Scene & { warnings: Warning[] };
