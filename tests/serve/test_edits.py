"""Edits by clients of the frame server: every frame shows them, and what is wrong changes nothing."""

from __future__ import annotations

import base64

import numpy as np
import pytest
from fakes.box_scenes import boxes, scene_of, view_of
from fakes.device import FakeDevice
from fakes.frame_server import controlled, frame_where, served
from msgspec.structs import replace
from oracles import worlds
from oracles.cuts import memory_of

from voxrt.board.edited_scene import rom_of
from voxrt.board.errors import DeviceError, Refused
from voxrt.board.simulated.model import ModelDevice
from voxrt.export import read_any
from voxrt.octree import Box, Octree, Sphere, World, to_dense
from voxrt.serve.frame_client import open_client
from voxrt.serve.server_options import Limits
from voxrt.sim import render

FREE = Limits(edits_per_second=1e6)
DIG = {"op": "fill", "sphere": {"centre": [8, 8, 8], "radius": 5}, "material": 0}


def editing(scene=None, device=None, limits=FREE):
    scene = scene or replace(boxes(1), name="Yard")
    return controlled(device or ModelDevice(capacity=40_000), loaded=scene, limits=limits)


async def show(client, view):
    camera = {name: list(getattr(view.camera, name)) for name in ("position", "look", "right", "up")}
    await client.request("view", camera=camera, size=list(view.size))


async def picture_after(client, request):
    packet = await frame_where(client, lambda packet: packet.request == request)
    return packet.frame.colour


async def test_every_frame_shows_the_edit_before_it():
    scene = boxes(1)
    world, view = World(rom_of(scene)), view_of(scene, (48, 32))
    async with editing(scene) as (server, client), open_client(server.url) as viewer:
        await show(client, view)
        low, high = [0, 0, 0], [16, 9, 16]
        edits = [
            (DIG, lambda: world.fill(Sphere((8, 8, 8), 5), 0)),
            (
                {"op": "set", "points": [[1, 2, 3], [4, 4, 4]], "materials": 2},
                lambda: world.set([[1, 2, 3], [4, 4, 4]], 2),
            ),
            (
                {"op": "paint", "box": {"low": low, "high": high}, "material": "material 1"},
                lambda: world.paint(Box(low, high), 1),
            ),
            ({"op": "undo"}, world.undo),
            ({"op": "redo"}, world.redo),
            (
                {"op": "paste", "box": {"low": low, "high": [8, 8, 8]}, "at": [8, 6, 3], "turned": 1},
                lambda: world.paste(world.copy(low, (8, 8, 8)), (8, 6, 3), turned=1),
            ),
        ]
        for number, (operation, same) in enumerate(edits, 1):
            same()
            figures = await client.edit(operation)
            undo, redo = world.steps
            assert (figures["number"], figures["undo"], figures["redo"]) == (number, undo, redo)
            expected = render(world.rom(), view.camera, view.size, engine="model").colour
            for one in (client, viewer):
                assert (await picture_after(one, client._requests) == expected).all()
        while client.state["scene"]["edits"]["number"] < len(edits):
            await client.request("counters")
        assert client.state["scene"]["edits"] == {"number": 6, "undo": 4, "redo": 0, "materials": 5}
        assert (await client.request("materials"))["materials"][1:] == [
            [one.name, "#{:02x}{:02x}{:02x}".format(*one.colour)] for one in server.session.renderer.world.materials[1:]
        ]


class History:
    """Edits of several authors as arrays of voxels: a voxel has what the last edit that changed it made of it."""

    def __init__(self, cube):
        self.begin, self.edits = cube, []

    def cube(self):
        cube = self.begin.copy()
        for _, before, after, undone in self.edits:
            if not undone:
                changed = before != after
                cube[changed] = after[changed]
        return cube

    def add(self, author, after):
        before = self.cube()
        self.edits = [edit for edit in self.edits if not (edit[0] == author and edit[3])]
        self.edits.append([author, before, after, False])

    def numbers(self, author, undone):
        return [number for number, edit in enumerate(self.edits) if edit[0] == author and edit[3] == undone]

    def undo(self, author):
        self.edits[self.numbers(author, undone=False)[-1]][3] = True

    def redo(self, author):
        self.edits[self.numbers(author, undone=True)[0]][3] = False


async def test_two_viewers_undo_their_own_edits():
    scene = boxes(1)
    history, rng = History(to_dense(rom_of(scene).octree)), np.random.default_rng(7)
    async with editing(scene) as (server, client), open_client(server.url) as viewer:
        renderer, people = server.session.renderer, [client, viewer]
        undone = 0
        for _ in range(120):
            author = int(rng.integers(2))
            one, other = people[author], people[1 - author]
            if server.session.control.controller != one.hello["viewer"]:
                await other.request("release")
                await one.take_control()
            choice = rng.choice(["undo", "redo", "set", "set"])
            if choice == "set":
                low = rng.integers(0, 13, 3)
                high, material = low + rng.integers(1, 4, 3), int(rng.integers(0, 4))
                box = {"low": low.tolist(), "high": high.tolist()}
                figures = await one.edit({"op": "fill", "box": box, "material": material})
                after = history.cube()
                after[tuple(map(slice, low, high))] = material
                if (after != history.cube()).any():
                    history.add(author, after)
            elif not history.numbers(author, undone=choice == "redo"):
                with pytest.raises(Refused, match="no edit to"):
                    await one.edit({"op": choice})
                continue
            else:
                (history.undo if choice == "undo" else history.redo)(author)
                figures = await one.edit({"op": choice})
                undone += 1
            counts = [len(history.numbers(author, undone=state)) for state in (False, True)]
            assert [figures["undo"], figures["redo"]] == counts
            known = {key: figures[key] for key in ("number", "undo", "redo", "materials")}
            assert server.session.state()["scene"]["edits"] == known
            np.testing.assert_array_equal(to_dense(renderer.world.rom().octree), history.cube())
        assert undone > 30
        view = view_of(scene, (48, 32))
        await show(one, view)
        expected = render(renderer.world.rom(), view.camera, view.size, engine="model").colour
        assert (await picture_after(other, one._requests) == expected).all()


async def test_edits_of_one_stroke_are_undone_together():
    scene = boxes(1)
    begin = to_dense(rom_of(scene).octree)
    async with editing(scene) as (server, client), open_client(server.url) as viewer:
        renderer = server.session.renderer

        async def set_voxel(one, x, stroke):
            return await one.edit({"op": "set", "points": [[x, 15, 15]], "materials": 3}, stroke=stroke)

        def is_set():
            return [bool(cell == 3) for cell in to_dense(renderer.world.rom().octree)[:8, 15, 15]]

        for x, stroke in enumerate([7, 7, 7, 0, 0, 8]):
            figures = await set_voxel(client, x, stroke)
        assert (figures["undo"], figures["redo"]) == (4, 0)
        await client.request("release")
        await viewer.take_control()
        await set_voxel(viewer, 6, 8)  # of another author
        await viewer.request("release")
        await client.take_control()
        figures = await set_voxel(client, 7, 8)  # the stroke of another is between
        assert (figures["undo"], is_set()) == (5, [True] * 8)
        expected = [[True] * 7 + [False], [True] * 5 + [False, True, False], [True] * 4 + [False] * 2 + [True, False]]
        expected += [[True] * 3 + [False] * 3 + [True, False], [False] * 6 + [True, False]]
        for number, one in enumerate(expected, 1):
            assert (await client.edit({"op": "undo"}))["redo"] == number
            assert is_set() == one
        await client.edit({"op": "redo"})
        assert is_set() == expected[3]
        with pytest.raises(Refused, match="is no request"):
            await client.edit({"op": "undo"}, stroke=-1)
        after = to_dense(renderer.world.rom().octree)
        after[:8, 15, 15] = begin[:8, 15, 15]
        np.testing.assert_array_equal(after, begin)


def cells_of(solid):
    words = np.frombuffer(base64.b64decode(solid["words"]), "<u4").astype(np.uint32)
    return to_dense(Octree(solid["depth"], words))


async def test_boxes_to_walk_in_are_those_of_the_voxels():
    scene, rng = boxes(1), np.random.default_rng(4)
    async with editing(scene) as (server, client):
        cube = to_dense(rom_of(scene).octree)
        for turn in range(40):
            if turn == 20:
                await client.edit(DIG)
                cube = to_dense(server.session.renderer.world.rom().octree)
            low = rng.integers(-20, 20, 3)
            high = low + rng.integers(1, 30, 3)
            found = cells_of((await client.request("solid", low=low.tolist(), high=high.tolist()))["solid"])
            expected = np.zeros_like(found)
            around = np.zeros((80, 80, 80), np.uint8)
            around[20:36, 20:36, 20:36] = cube != 0
            sides = high - low
            expected[: sides[0], : sides[1], : sides[2]] = around[tuple(map(slice, low + 20, high + 20))]
            np.testing.assert_array_equal(found, expected)


async def test_boxes_to_walk_in_have_bounds():
    rng = np.random.default_rng(5)
    noise = scene_of(memory_of(worlds.noise(6, 0.5, 1)), 6)
    async with editing(noise, ModelDevice(capacity=400_000)) as (server, client):
        for low, high, problem in (
            ([0, 0, 0], [64, 64, 64], "the most; make it smaller"),
            ([0, 0, 0], [65537, 1, 1], "65537 x 1 x 1 voxels is too large; make it smaller"),
            ([0, 0, 0], [0, 1, 1], "is empty; its end is one behind the highest voxel"),
            ([2**40, 0, 0], [2**40 + 1, 1, 1], "out of reach|low"),
            ([0, 0], [1, 1, 1], "is no request"),
            ([4, 0, 0], [1, 1, 1], "below its start"),
        ):
            with pytest.raises(Refused, match=problem) as refused:
                await client.request("solid", low=low, high=high)
            assert "\n" not in str(refused.value)
        low = rng.integers(0, 48, 3)
        await client.request("solid", low=low.tolist(), high=(low + 16).tolist())
    solid = replace(boxes(1), depth=16, words=np.array([0xFFFFFF01], np.uint32))
    async with editing(solid) as (server, client):
        with pytest.raises(Refused, match="too many different octants; make it smaller"):
            await client.request("solid", low=[1, 1, 1], high=[65535, 65535, 65535])
        async with open_client(server.url) as viewer:
            with pytest.raises(Refused, match="take control first"):
                await viewer.request("solid", low=[0, 0, 0], high=[1, 1, 1])


async def test_rays_find_edited_voxels():
    scene = boxes(1)
    async with editing(scene) as (_, client):
        ray = {"origin": [16 * 8 + 8, 16 * 40, 16 * 8 + 8], "direction": [0, -100, 3]}
        before = (await client.request("ray", **ray))["hit"]
        await client.edit({"op": "set", "points": [[8, 15, 9]], "materials": 2})
        hit = (await client.request("ray", **ray))["hit"]
        assert hit != before
        x, y, z = hit["point"]
        assert (hit["voxel"], hit["material"], hit["face"], x, y) == ([8, 15, 9], 2, 1, 8.5, 16)
        assert z == 8.5 + 24 * 0.03
        await client.edit({"op": "undo"})
        assert (await client.request("ray", **ray))["hit"] == before
        inside = await client.request("ray", origin=[8, 8, 8], direction=[0, 0, 0])
        assert inside["hit"] is None or inside["hit"]["face"] is None


async def test_a_material_is_added_and_saved(tmp_path):
    async with editing() as (_, client):
        figures = await client.edit({"op": "material", "name": "gold", "colour": "#fac83c"})
        await client.edit({"op": "set", "points": [[15, 15, 15]], "materials": "gold"})
        gold = figures["materials"] - 1
        for suffix, names in ((".mem", ["Yard.mem", "Yard.json"]), (".blob", ["Yard.blob"]), (".vox", ["Yard.vox"])):
            files = await client.save(suffix)
            assert list(files) == names
            for name, data in files.items():
                (tmp_path / name).write_bytes(data)
            rom = read_any(tmp_path / names[0])[0].rom
            colours = [material.colour for material in rom.materials]
            assert (250, 200, 60) in colours
            if suffix != ".vox":
                assert rom.materials[gold].name == "gold"
                world = World(rom_of(replace(boxes(1), name="Yard")))
                world.set([[15, 15, 15]], world.add_material(rom.materials[gold]))
                np.testing.assert_array_equal(rom.octree.words, world.rom().octree.words)


@pytest.mark.parametrize(
    ("operation", "problem"),
    [
        ({"op": "dig"}, "is no request"),
        ({"op": "fill", "material": 0}, "one of box, sphere and capsule"),
        ({**DIG, "material": 200}, "material must be an integer 0 … 4"),
        ({**DIG, "material": "gold"}, "there is no material 'gold'"),
        ({**DIG, "radius": 3}, "unknown field"),
        ({**DIG, "sphere": {"centre": [8, 8, 8], "radius": 257}}, "has 514 voxels per side, and an edit may have 512"),
        ({**DIG, "sphere": {"centre": [1e300, 8, 8], "radius": 1}}, "multiples of 1/16"),
        ({**DIG, "sphere": {"centre": [8, 8], "radius": 1}}, "is no request"),
        ({"op": "fill", "capsule": {"start": [0, 0, 0], "end": [600, 0, 0], "radius": 1}, "material": 1}, "602 voxels"),
        ({"op": "fill", "box": {"low": [0, 0, 0], "high": [1, 1, 513]}, "material": 1}, "513 voxels"),
        ({"op": "paste", "box": {"low": [0, 0, 0], "high": [1, 129, 1]}, "at": [0, 0, 0]}, "may have 128"),
        ({"op": "paste", "file": "/etc/passwd", "at": [0, 0, 0]}, "is no request"),
        ({"op": "set", "points": [[0, 0, 16]], "materials": 1}, "points"),
        ({"op": "set", "points": [[0, 0, 1]], "materials": [1, 2]}, "not"),
        ({"op": "set", "points": [[0, 0, 2**80]], "materials": 1}, "is no request|points"),
        ({"op": "material", "name": "\u202egold", "colour": "#fac83c"}, "printable"),
        ({"op": "material", "name": "x" * 201, "colour": "#fac83c"}, "printable"),
        ({"op": "material", "name": "gold", "colour": "no"}, "colour"),
        ({"op": "undo"}, "no edit to undo"),
        ({"op": "redo"}, "no edit to do again"),
        ([], "is no request"),
    ],
)
async def test_what_is_wrong_changes_nothing(operation, problem):
    async with editing() as (server, client):
        with pytest.raises(Refused, match=problem) as refused:
            await client.edit(operation)
        assert "\n" not in str(refused.value)
        assert server.session.renderer.edits(None)["number"] == 0
        await client.edit(DIG)


async def test_only_who_has_control_edits_and_saves():
    async with editing() as (server, client), open_client(server.url) as viewer:
        for request in (viewer.edit(DIG), viewer.save(), viewer.request("part", offset=0)):
            with pytest.raises(Refused, match="take control first"):
                await request
        await client.request("save", suffix=".mem")
        await client.request("release")
        await viewer.take_control()
        with pytest.raises(Refused, match="no scene was saved"):
            await viewer.request("part", offset=0)
        await viewer.edit(DIG)


async def test_edits_that_come_too_fast_are_refused():
    async with editing(limits=Limits(edits_per_second=1)) as (server, client):
        answers = [await client.send("edit", operation=DIG) for _ in range(20)]
        refused = 0
        for number in answers:
            try:
                await client._answer(number)
            except Refused as refusal:
                refused += "more than 1 edits per second" in str(refusal)
        assert refused >= 16
        assert server.session.renderer.edits(None)["number"] == 20 - refused


async def test_a_world_without_room_refuses_and_stays():
    scene = boxes(1)
    device = ModelDevice(capacity=len(scene.words) + 160)
    async with editing(scene, device) as (server, client):
        rng = np.random.default_rng(1)
        with pytest.raises(Refused, match="does not fit"):  # noqa: PT012 - until there is no room
            for _ in range(200):
                points = rng.integers(0, 16, (1, 3)).tolist()
                await client.edit({"op": "set", "points": points, "materials": 1})
        before = server.session.renderer.edits(None)
        assert before["number"] > 0
        await client.edit({"op": "fill", "box": {"low": [0, 0, 0], "high": [16, 16, 16]}, "material": 0})


@pytest.mark.parametrize("blocks", range(4, 16))
async def test_an_edit_or_undo_without_room_changes_nothing(blocks):
    scene, rng = boxes(1), np.random.default_rng(blocks)
    async with editing(scene, ModelDevice(capacity=len(scene.words) + 8 * blocks)) as (server, client):
        renderer, refused = server.session.renderer, 0
        for _ in range(40):
            world = renderer.world
            before = (world.rom().octree.words, renderer.edits(client.hello["viewer"]), world.image) if world else None
            points = rng.integers(0, 16, (1, 3)).tolist()
            op = str(rng.choice(["undo", "redo", "set", "set"]))
            try:
                await client.edit({"op": op, "points": points, "materials": 3} if op == "set" else {"op": op})
            except Refused as refusal:
                refused += "does not fit" in str(refusal)
                if before:
                    words, edits, image = before
                    np.testing.assert_array_equal(world.rom().octree.words, words)
                    assert (renderer.edits(client.hello["viewer"]), len(world.image)) == (edits, len(image))
                else:
                    assert renderer.world is None
            else:
                device = renderer.device
                root = renderer.world.live_roots[-1]
                words = device.read_memory(0, len(renderer.world.image))
                words[0] = words[root]
                shown = to_dense(Octree(scene.depth, words))
                np.testing.assert_array_equal(shown, to_dense(renderer.world.rom().octree))
        assert refused > 0 or blocks > 9


async def test_animations_are_not_edited():
    scene = boxes(1)
    film = replace(scene, roots=(0, 1), period=0.5)
    async with editing(film) as (_, client):
        with pytest.raises(Refused, match="is an animation, whose frames share blocks"):
            await client.edit(DIG)
        with pytest.raises(Refused, match="is an animation"):
            await client.save()


async def test_a_scene_that_is_loaded_ends_the_edits():
    first, second = boxes(1), boxes(2)
    async with editing(first) as (server, client):
        await client.edit(DIG)
        await server.session.renderer.load(second, lambda *_: None)
        view = view_of(second, (48, 32))
        await show(client, view)
        expected = render(rom_of(second), view.camera, view.size, engine="model").colour
        assert (await picture_after(client, client._requests) == expected).all()
        with pytest.raises(Refused, match="no edit to undo"):
            await client.edit({"op": "undo"})
        await client.edit(DIG)
        assert (await client.edit({"op": "undo"}))["number"] == 2
        assert (await picture_after(client, client._requests) == expected).all()


async def test_a_device_that_fails_shows_the_voxels_before_and_then_both():
    device = FakeDevice(capacity=4000)
    async with editing(device=device) as (server, client):
        await client.edit({"op": "set", "points": [[1, 1, 1]], "materials": 1})
        before = device.octree()
        device.fail_write_at = device.writes
        with pytest.raises(Refused, match="the bus does not answer"):
            await client.edit(DIG)
        assert device.octree() == before
        await client.edit({"op": "set", "points": [[1, 1, 2]], "materials": 1})
        assert server.session.renderer.edits(None)["number"] == 2
        assert device.octree() != before


async def test_an_edit_of_a_scene_that_is_replaced_is_refused():
    async with editing(boxes(1)) as (server, client):
        renderer = server.session.renderer
        async with renderer._loading:
            request = await client.send("edit", operation=DIG)
            async with open_client(server.url) as viewer:
                await viewer.request("counters")  # the edit waits, and nobody else
            renderer.scene_number += 1
        with pytest.raises(Refused, match="another scene was loaded meanwhile"):
            await client._answer(request)


async def test_parts_that_nobody_reads_are_refused():
    async with editing() as (_, client):
        files = (await client.request("save", suffix=".blob"))["files"]
        with pytest.raises(Refused, match="the files end at byte"):
            await client.request("part", offset=files[0]["size"])
        with pytest.raises(Refused, match="is no request"):
            await client.request("save", suffix=".exe")


async def test_scenes_of_devices_without_a_world():
    async with served(ModelDevice(capacity=1000)) as server, open_client(server.url) as client:
        await client.take_control()
        await client.edit({"op": "material", "name": "oak", "colour": "#a06e3c"})
        figures = await client.edit({"op": "set", "points": [[1, 1, 1]], "materials": "oak"})
        assert figures["blocks"] == 1
        assert (await client.save(".vox")).keys() == {"nothing.vox"}


async def test_device_errors_of_the_first_edit():
    class Broken(ModelDevice):
        broken = False

        def apply_patch(self, patch, depth):
            if self.broken:
                raise DeviceError("the line is dead")
            super().apply_patch(patch, depth)

    device = Broken()
    async with editing(device=device) as (_, client):
        device.broken = True
        with pytest.raises(Refused, match="the line is dead"):
            await client.edit(DIG)
        device.broken = False
        assert (await client.edit(DIG))["number"] == 1
