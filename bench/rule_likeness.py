"""Which rule looks right: previews by each rule beside reference pictures of their sources, at equal depth and words.

Usage: ``python bench/rule_likeness.py [--write] [--only WORD]``. The assets and the reference pictures are those of
``bench/likeness.py``. Each asset is built at depths 5 to 8 by each rule, with thin parts and without them, and seen by
one camera per depth. Figures are SSIM and PSNR of whole pictures. Words at one depth differ, so each rule is also held
against ``touch`` at equal words: its figures between two depths are taken from a straight line over the logarithm of
the words.
"""

from __future__ import annotations

import numpy as np
from likeness import ASSETS, NAMES, coarser
from reference_picture import Reference
from report import options_of, publish, table

import voxrt
from voxrt.octree.camera import pixel_directions
from voxrt.sim import structural_similarity
from voxrt.sim.baking.daylight import Daylight
from voxrt.voxelize import AssetError
from voxrt.voxelize.colour.srgb import linear_from_srgb, srgb_from_linear

DEPTHS, SIZE, FINER, SKY_RAYS = range(5, 9), (160, 120), 2, 16
RULES = {"touch": {}} | {
    rule + ending: {"rule": rule} | thin
    for rule in ("centre", "half")
    for ending, thin in (("", {}), (", thin dropped", {"thin": "drop"}))
}


def measure(name: str) -> dict[str, np.ndarray]:
    """Give words, SSIM and PSNR of each depth, by rule: float64, shape (D, 3)."""
    found: dict[str, list[tuple[float, float, float]]] = {rule: [] for rule in RULES}
    scene = voxrt.load(ASSETS / name, allow_outside=True)
    fine = (FINER * SIZE[0], FINER * SIZE[1])
    for depth in DEPTHS:
        options = voxrt.BuildOptions(depth=depth, geometry="render", allow_empty=True)
        built = {rule: voxrt.build(scene, options=options, **choice).rom for rule, choice in RULES.items()}
        camera = voxrt.aim_camera(built["touch"], fine)
        reference = reference_of(scene, built["touch"], camera, fine)
        for rule, rom in built.items():
            frame = voxrt.render(rom, camera, size=fine, engine="model")
            picture = srgb_from_linear(coarser(linear_from_srgb(frame.colour)))
            error = ((picture.astype(float) - reference) ** 2).mean()
            psnr = 10 * np.log10(255**2 / max(error, 1e-9))
            found[rule].append((len(rom.octree.words), structural_similarity(picture, reference), psnr))
    return {rule: np.array(rows) for rule, rows in found.items()}


def reference_of(scene: voxrt.Scene, rom: voxrt.Rom, camera: voxrt.Camera, fine: tuple[int, int]) -> np.ndarray:
    assert rom.grid is not None
    ways = pixel_directions(camera, fine).reshape(-1, 3).astype(np.float64)
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    origins = np.broadcast_to(np.array(camera.position) / 16, ways.shape)
    background = linear_from_srgb(np.array(rom.materials[0].colour))
    colour, _ = Reference(scene, rom.grid).shade(origins, ways, Daylight(), background, SKY_RAYS)
    return srgb_from_linear(coarser(np.clip(colour, 0, 1).reshape(fine[1], fine[0], 3)))


def at_words(rows: np.ndarray, words: np.ndarray) -> np.ndarray:
    """Give SSIM and PSNR of a rule at other words; NaN beyond those of its depths."""
    order = np.argsort(rows[:, 0])
    logs = np.log(rows[order, 0])
    wanted = np.log(words)
    values = np.stack([np.interp(wanted, logs, rows[order, column]) for column in (1, 2)], axis=1)
    values[(wanted < logs[0]) | (wanted > logs[-1])] = np.nan
    return values


def main() -> None:
    parser = options_of(__doc__)
    parser.add_argument("--only", default="", help="assets whose path holds this")
    options = parser.parse_args()
    rows, nearer, gains = [], {}, {}
    for name in NAMES.split():
        if options.only not in name or not (ASSETS / name).exists():
            continue
        try:
            found = measure(name)
        except AssetError as error:
            print(f"{name}: {error}", flush=True)
            continue
        cells = []
        for rule in list(RULES)[1:]:
            by_depth = found[rule][:, 1:] - found["touch"][:, 1:]
            by_words = found[rule][:, 1:] - at_words(found["touch"], found[rule][:, 0])
            for kind, gain in (("depth", by_depth), ("words", by_words)):
                mean = np.nanmean(gain, axis=0) if np.isfinite(gain).any() else np.full(2, np.nan)
                nearer.setdefault((rule, kind), []).append(mean > 0)
                gains.setdefault((rule, kind), []).append(mean)
                cells.append(f"{mean[0]:+.3f} / {mean[1]:+.1f}")
        rows.append((f"`{name}`", *cells))
        print(*rows[-1], flush=True)
    summary = []
    for (rule, kind), better in nearer.items():
        ssim, psnr = np.nanmean(gains[rule, kind], axis=0)
        counts = (f"{count} of {len(rows)}" for count in np.sum(better, axis=0))
        summary.append((rule, f"equal {kind}", *counts, f"{ssim:+.3f}", f"{psnr:+.2f}"))
    head = ("asset", *(f"{rule}, {kind}" for rule, kind in nearer))
    page = (
        "# Which rule looks right\n\n"
        f"Previews at depths {DEPTHS[0]} to {DEPTHS[-1]} against reference pictures of their triangles, by "
        "`bench/rule_likeness.py`: how much\nnearer than `touch` each rule is, on average over the depths. PSNR is in "
        "dB. Cells of assets: SSIM / PSNR.\n\n"
        + table(("rule", "at", "nearer by SSIM", "nearer by PSNR", "SSIM", "PSNR"), summary, 2)
        + "\n"
        + table(head, rows, 1)
    )
    publish("rule_likeness.md", page, write=options.write)


if __name__ == "__main__":
    main()
