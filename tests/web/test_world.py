"""Worlds that are edited in WebAssembly, against those of Python: the same words, patches, pictures and voxels."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from fakes.site import node, registers_of, sha

from voxrt.octree import Box, Capsule, Rom, Sphere, World, from_dense
from voxrt.octree.camera import frame_points
from voxrt.sim import Picked, outline, pick, render
from voxrt.voxelize import EMPTY, Material

if TYPE_CHECKING:
    from collections.abc import Sequence

SIZE = (97, 61)
MATERIALS = (EMPTY, *(Material(f"stone {id_}", (40 * id_, 255 - 40 * id_, 90)) for id_ in range(1, 6)))
SHAPES = {"box": Box, "sphere": Sphere, "capsule": Capsule}


def random_rom(rng: np.random.Generator, depth: int) -> Rom:
    side = 1 << depth
    places = np.indices((side,) * 3).sum(0)
    dense = np.where(places < 1.5 * side, rng.integers(1, 4), 0).astype(np.uint8)
    rough = rng.random((side,) * 3) < 0.05
    dense[rough] = rng.integers(0, 6, np.count_nonzero(rough))
    return Rom("random", from_dense(dense), MATERIALS)


def as_material(material: Material) -> dict[str, Any]:
    colour = list(material.colour)
    return {"name": material.name, "colour": colour, "mirror": material.mirror, "authored": material.authored}


def random_shape(rng: np.random.Generator, side: int) -> dict[str, Any]:
    def place() -> list[float]:
        return (rng.integers(-2 * side, 20 * side, 3) / 16).tolist()

    match rng.integers(3):
        case 0:
            low = rng.integers(-2, side, 3)
            return {"box": {"low": low.tolist(), "high": (low + rng.integers(0, side // 2, 3)).tolist()}}
        case 1:
            return {"sphere": {"centre": place(), "radius": int(rng.integers(0, 6 * side)) / 16}}
        case _:
            return {"capsule": {"start": place(), "end": place(), "radius": int(rng.integers(0, 3 * side)) / 16}}


def random_steps(rng: np.random.Generator, depth: int, count: int) -> list[list[Any]]:
    side = 1 << depth
    steps: list[list[Any]] = []
    for _ in range(count):
        match rng.integers(7):
            case 0 | 1:
                voxels = rng.integers(0, side, (int(rng.integers(1, 9)), 3))
                steps.append(["set", voxels.ravel().tolist(), rng.integers(0, 6, len(voxels)).tolist()])
            case 2 | 3:
                steps.append(["fill", random_shape(rng, side), int(rng.integers(0, 6))])
            case 4:
                steps.append(["paint", random_shape(rng, side), int(rng.integers(1, 6))])
            case 5:
                steps.append([["undo", "redo"][rng.integers(2)]])
            case _:
                origin = rng.integers(-16 * side, 32 * side, 3)
                aim = rng.integers(0, 16 * side, 3) - origin
                steps.append(["pick", origin.tolist(), (aim + (aim == 0)).tolist()])
        if rng.random() < 0.4:
            steps.append(["commit"])
        if rng.random() < 0.4:
            steps.append(["stroke", int(rng.integers(3))])
    return [*steps, ["commit"]]


def natively(world: World, step: list[Any]) -> Any:
    """What Python's World returns for a step, as the script writes it."""
    match step:
        case ["set", voxels, materials]:
            return world.set(np.reshape(voxels, (-1, 3)), materials)
        case ["fill" | "paint" as call, shape, material]:
            ((kind, values),) = shape.items()
            return getattr(world, call)(SHAPES[kind](**values), material)
        case ["pick", origin, direction]:
            found = pick(world, np.array(origin) / 16, direction)
            return found and as_picked(found)
        case ["stroke", number]:
            world.stroke = number
            return None
        case [call]:
            return getattr(world, call)()
    raise AssertionError(step)


def as_picked(found: Picked) -> dict[str, Any]:
    beside = None if found.beside is None else list(found.beside)
    return {"voxel": list(found.voxel), "beside": beside, "material": found.material}


def committed(world: World, camera: Any) -> dict[str, Any]:
    """A commit, and all that can be known of it; older roots are released."""
    patch = world.commit()
    for root in world.live_roots[:-1]:
        world.release(root)
    figures = world.figures()
    return {
        "root": patch.root,
        "rootWord": patch.root_word,
        "addresses": patch.addresses.tolist(),
        "patch": sha(patch.blocks),
        "words": sha(world.rom().octree.words),
        "image": sha(world.image),
        "colour": sha(render(world.rom(), camera, SIZE, engine="model").colour),
        "blocks": figures.blocks,
        "kept": figures.kept,
        "free": figures.free,
    }


@pytest.mark.parametrize("depth", [1, 3, 5, 7])
def test_any_edits_have_the_words_patches_and_pictures_of_python(depth: int) -> None:
    rng = np.random.default_rng(depth)
    rom = random_rom(rng, depth)
    camera = frame_points(outline(rom.octree), SIZE)
    steps = random_steps(rng, depth, 60)
    job = {
        "words": rom.octree.words.tolist(), "depth": depth, "materials": [as_material(one) for one in MATERIALS],
        "limits": {"undoSteps": 7}, "steps": steps, "camera": registers_of(camera), "size": SIZE,
    }  # fmt: skip
    (found,) = node("edit_worlds.mjs", [job])
    world = World(rom, undo_steps=7)
    for number, (step, result) in enumerate(zip(steps, found["results"], strict=True)):
        if step == ["commit"]:
            assert result == committed(world, camera), (number, step)
        else:
            assert result == natively(world, step), (number, step)
    assert tuple(found["steps"]) == world.steps


def results_of(steps: Sequence[list[Any]], **limits: int) -> tuple[list[Any], dict[str, Any]]:
    rom = random_rom(np.random.default_rng(0), 3)
    camera = registers_of(frame_points(outline(rom.octree), SIZE))
    materials = [as_material(one) for one in MATERIALS]
    job = {"words": rom.octree.words.tolist(), "depth": 3, "materials": materials, "limits": limits, "steps": steps}
    (found,) = node("edit_worlds.mjs", [{**job, "camera": camera, "size": SIZE}])
    return found["results"], found


def test_an_edit_without_room_is_refused_and_changes_nothing() -> None:
    rom = random_rom(np.random.default_rng(0), 3)
    most = len(rom.octree.words)
    voxels = np.random.default_rng(1).integers(0, 8, (200, 3)).ravel().tolist()
    results, found = results_of([["set", voxels, [5] * 200], ["words"]], words=most)
    problem = f"the result of the edit does not fit the {most:,} words of the world's memory"
    assert results[0] == {"problem": f"VoxrtError: {problem}"}
    assert list(results[1].values()) == rom.octree.words.tolist()
    assert found["steps"] == [0, 0]


@pytest.mark.parametrize(
    ("step", "problem"),
    [
        (["set", [8, 0, 0], [1]], "a voxel lies beyond the world of 8 voxels per side"),
        (["set", [0.5, 0, 0], [1]], "each voxel must have three whole numbers and a material"),
        (["set", [0, 0, 0], [6]], "material must be 0 … 5, not 6"),
        (["paint", {"sphere": {"centre": [1, 1, 1], "radius": 1}}, 0], "material must be 1 … 5, not 0"),
        (
            ["fill", {"sphere": {"centre": [0.3, 0, 0], "radius": 1}}, 0],
            "a place must have multiples of 1/16 voxel up to 2**20, not 0.3,0,0",
        ),
        (["fill", {"sphere": {"centre": [0, 0, 0], "radius": -1}}, 0], "a radius must be 0 or more, not -1"),
        (
            ["fill", {"box": {"low": [0, 0, 0.5], "high": [1, 1, 1]}}, 0],
            "the corners of a box must be whole numbers up to 2**20",
        ),
        (["fill", {"box": {"low": [2, 0, 0], "high": [1, 1, 1]}}, 0], "a box must have its low corner below high"),
        (["pick", [0, 0, 0], [1 << 20, 0, 0]], "the direction is not below 2**20"),
        (["release", 5], "the root at word 5 is not live"),
    ],
)
def test_what_is_wrong_with_an_edit_is_one_line(step: list[Any], problem: str) -> None:
    (found,), _ = results_of([step])
    assert found["problem"].startswith(f"VoxrtError: {problem}")


def test_materials_are_added_until_there_are_255() -> None:
    new = [as_material(Material(f"new {number}", (number, 0, 0))) for number in range(251)]
    results, found = results_of([["addMaterial", one] for one in [new[0], as_material(MATERIALS[2]), *new]])
    assert results[:4] == [6, 2, 6, 7]
    assert results[-1] == {"problem": "VoxrtError: the world has 255 materials, which is the most: use one of them"}
    assert len(found["materials"]) == 256
