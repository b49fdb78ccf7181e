import type { Appearance, Scene, Voxrt, Warning } from "./voxrt.js";

/** Sets numbers of a vertex. */
export type Setter = (vertex: number, out: { [index: number]: number }) => void;

export interface Rules {
  /** What makes meshes one object. */
  groupOf?(mesh: object): unknown;
  nameOf?(mesh: object, group: unknown): string;
  /** Null for the default material; `colour` (sRGB) replaces that of the material. */
  materialOf?(material: object): {
    key: unknown; name: string; order?: number; colour?: number[]; mirror?: boolean; authored?: boolean;
  } | null;
  /** Null where the material's colour is uniform. `covers`: whether a vertex has a colour; a triangle of which none has is plain. */
  appearanceOf?(material: object, geometry: object, warn: (kind: string, message: string) => void): {
    entry: Appearance; uvOf?: Setter | null; colourOf?: Setter | null; covers?(vertex: number): boolean;
  } | null;
  /** An attribute of three.js with the author's normals, for baked light; null for none. */
  normalsOf?(mesh: object): object | null;
  /** Whether a material is fully transparent. */
  isLeftOut?(material: object): boolean;
}

/** Sets linear colour and alpha from an attribute of three.js. */
export function colours(attribute: object): Setter;

/** The visible meshes below an object of three.js, at this moment. */
export function sceneOf(root: object, voxrt: Voxrt, rules?: Rules): Scene & { warnings: Warning[] };
