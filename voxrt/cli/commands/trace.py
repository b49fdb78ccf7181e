"""``voxrt trace``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxrt.cli.inputs.lighting import merge_lighting
from voxrt.cli.inputs.source import read_source
from voxrt.cli.results.build_results import print_json
from voxrt.cli.results.memory_results import trace_result
from voxrt.cli.terminal.errors import UsageError
from voxrt.cli.terminal.messages import summarize, tabulate
from voxrt.export.outputs import writing
from voxrt.sim import explain_colour, follow_pixel
from voxrt.sim.wave import record_wave
from voxrt.sim.wave_files import GTKWAVE_MARKERS, check_wave, write_wave
from voxrt.view.ray_table import HEADS, describe_end, describe_root, ray_table

if TYPE_CHECKING:
    from pathlib import Path

    from voxrt.octree import Rom
    from voxrt.options.picture_commands import TraceCommand
    from voxrt.sim import PixelColour, RayPath
    from voxrt.sim.pixel_colour import Surface
    from voxrt.sim.wave import Wave

_LIGHTS = {
    "lit": "shines on it",
    "turned away": "is behind it: its side is turned away",
    "shadowed": "does not reach it: a solid stands between, so it is in shadow",
}


def run(options: TraceCommand) -> None:
    """Print the path of one pixel's ray through the octree, and how the pixel gets its colour."""
    pixel, size = options.pixel, options.size
    check_pixel(pixel, size)
    if options.wave:
        check_wave(options.wave)
    source = read_source(options.scene, options.depth)
    camera = source.camera(size, options.sight)
    path = follow_pixel(source.rom.octree, camera, size, pixel)
    lighting = merge_lighting(source.blob.lighting, options.lighting)
    colour = explain_colour(source.rom, path, lighting)
    wave, outputs = _write_wave(source.rom, path, options.wave) if options.wave else (None, {})
    if options.reporting.json:
        print_json(trace_result(camera, size, pixel, path, colour=colour, outputs=outputs))
        return
    x, y, z = (f"{value / 16:g}" for value in path.origin)
    summarize(
        f"{options.scene.name}, pixel {pixel[0]},{pixel[1]} of {size[0]}x{size[1]}:",
        [
            ("ray", f"from voxel {x}, {y}, {z} along {', '.join(map(str, path.direction))}"),
            ("root", describe_root(source.rom, path)),
            ("reads", f"{len(path.readings)} words"),
            ("hits", describe_end(source.rom, path)),
        ],
        answer=True,
    )
    if path.readings:
        tabulate(HEADS, ray_table(source.rom, path), answer=True)
    summarize("The colour of the pixel:", _colour_rows(source.rom, colour), answer=True)
    if wave:
        summarize("The wave of the ray:", wave_rows(wave, outputs))


def _write_wave(rom: Rom, path: RayPath, file: Path) -> tuple[Wave, dict[str, str]]:
    wave = record_wave(rom, path)
    with writing(file):
        return wave, {kind: str(written) for kind, written in write_wave(wave, file).items()}


def wave_rows(wave: Wave, outputs: dict[str, str]) -> list[tuple[str, str]]:
    """Give the rows of what was recorded, and of how to look at it."""
    file, gtkwave, surfer = outputs.values()
    unmarked = len(wave.words) - GTKWAVE_MARKERS
    rays = f"the lane traces {wave.rays} rays, this one first: no register of the camera holds its direction"
    markers = f"GTKWave has none for the last {unmarked} of {len(wave.words)} words"
    return [
        *([("rays", rays)] if wave.rays > 1 else []),
        *([("markers", markers)] if unmarked > 0 else []),
        *(("wrote", each) for each in outputs.values()),
        ("GTKWave", f"gtkwave {file} {gtkwave}"),
        ("Surfer", f"surfer --command-file {surfer} {file}"),
    ]


def _colour_rows(rom: Rom, colour: PixelColour) -> list[tuple[str, str]]:
    rows = [("mirror", _described(rom, mirror)) for mirror in colour.mirrors]
    result, surface = "#{:02x}{:02x}{:02x}".format(*colour.rgb), colour.surface
    if surface is None:
        why = "the mean of the mirrors: the ray has no reflections left" if colour.is_mean else "the background"
        return [*rows, ("colour", f"{result}, {why}")]
    rows.append(("surface", _described(rom, surface)))
    if surface.face is None:
        return [*rows, ("colour", f"{result}, that of the material: the camera stands in it")]
    if colour.face_brightness is not None:
        register = f"{'upper' if surface.face[0] == '+' else 'lower'}_faces.{surface.face[1]}"
        rows.append(("face", f"{surface.face} has brightness {colour.face_brightness} of 255 (register {register})"))
    if colour.light in _LIGHTS:
        rows.append(("light", _LIGHTS[colour.light]))
    rows.append(("brightness", f"{colour.brightness:.4f}, by the shading {colour.shading}"))
    return [*rows, ("colour", f"{result}, the material's times the brightness")]


def _described(rom: Rom, surface: Surface) -> str:
    x, y, z = surface.voxel
    side = "from within" if surface.face is None else f"its {surface.face} side"
    colour = "#{:02x}{:02x}{:02x}".format(*rom.materials[surface.material].colour)
    return f"voxel {x}, {y}, {z}, {side}: material {surface.material}, {surface.name}, {colour}"


def check_pixel(pixel: tuple[int, int], size: tuple[int, int]) -> None:
    """Refuse a pixel outside the picture."""
    if pixel[0] >= size[0] or pixel[1] >= size[1]:
        raise UsageError(
            f"pixel {pixel[0]},{pixel[1]} lies outside the picture of {size[0]}x{size[1]}; columns go to "
            f"{size[0] - 1}, rows to {size[1] - 1}"
        )
