// From which opacity a surface is solid, and the words for faces that are left out: those of voxelize/formats/opacity.py.

/** The default of voxrt build. */
export const OPAQUE_FROM = 0.5;

const BELOW_THRESHOLD = "faces below the opacity threshold of their material were left out";

/** Why faces are left out; null where they stay. @param {number} opacity the highest that they have @param {number}
 * cutoff what they need @returns {string | null} */
export function leftOut(opacity, cutoff) {
  if (!(opacity < cutoff)) return null;
  if (opacity <= 0) return "fully transparent faces were left out";
  if (cutoff !== OPAQUE_FROM) return BELOW_THRESHOLD;
  return (
    `faces less opaque than ${OPAQUE_FROM} were left out: a lower --opaque-from keeps them, ` +
    "unless their material has a threshold"
  );
}
