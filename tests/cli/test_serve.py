"""``voxrt serve`` and ``voxrt upload``, each in a process of its own."""

from __future__ import annotations

import asyncio
import json
import os
import signal
import subprocess
import sys
from contextlib import contextmanager

import numpy as np
import pytest
from fakes.blob import blob_of
from fakes.board_agent import running_agent
from fakes.device import wide_scene
from fakes.ecp5_board import Board
from fakes.pynq import Core, install
from fakes.serial_line import serial_line

from voxrt import read_any
from voxrt.board.designs.serial_device import SerialDevice
from voxrt.board.designs.serial_link import SerialLink
from voxrt.board.simulated.model import ModelDevice
from voxrt.octree import Octree, to_dense
from voxrt.serve.frame_client import open_client


@contextmanager
def serving(folder, *arguments):
    """A running ``voxrt serve``: what it wrote on standard output; ended by Ctrl-C."""
    command = [sys.executable, "-m", "voxrt", "serve", *arguments, "--port", "0", "--json"]
    with subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        try:
            lines = []
            for line in process.stdout:
                lines.append(line)
                if line.startswith("}"):
                    break
            assert lines, process.stderr.read()
            yield json.loads("".join(lines))
        finally:
            process.send_signal(signal.SIGINT)
            _, errors = process.communicate(timeout=60)
    assert process.returncode == 0, errors


async def show_all(url):
    """The words of each scene that a server offers, by name."""
    async with open_client(url) as client:
        await client.take_control()
        words = {}
        for name in client.hello["scenes"]:
            number = await client.send("show", scene=name)
            while (answer := await client._answer(number))["type"] != "done":
                pass
            words[name] = answer["scene"]["words"]
        return words


def test_a_server_without_scenes_offers_the_examples(folder):
    with serving(folder, "--depth", "5") as served:
        words = asyncio.run(asyncio.wait_for(show_all(served["url"]), 300))
    assert list(words) == ["courtyard", "dog", "house", "planet"]
    assert min(words.values()) > 100


def test_scenes_of_the_same_stem_are_all_served(folder):
    for name, source in (("one", "house.obj"), ("two", "dog.usda")):
        (folder / name).mkdir()
        (folder / name / "scene").with_suffix((folder / source).suffix).write_bytes((folder / source).read_bytes())
    (folder / "two" / "scene.obj").write_bytes((folder / "house.obj").read_bytes())
    with serving(folder, "one/scene.obj", "two/scene.usda", "two/scene.obj", "--depth", "5") as served:
        words = asyncio.run(asyncio.wait_for(show_all(served["url"]), 300))
    assert sorted(words) == ["one/scene.obj", "scene.usda", "two/scene.obj"]
    assert words["one/scene.obj"] == words["two/scene.obj"] != words["scene.usda"]


def test_upload_to_a_server(voxrt, folder):
    assert voxrt("build", "dog.usda", "--depth", 5).code == 0
    with serving(folder, "house.obj", "--depth", "4", "--legacy-port", "0") as served:
        assert served["legacy_port"] > 0
        checked = voxrt.json("upload", "dog.mem", "--to", served["url"], "--dry-run")
        assert checked["written"] is False
        assert voxrt.json("upload", "dog.mem", "--to", served["url"]) | {"written": False} == checked
        os.truncate(folder / "dog.json", 10)
        assert voxrt("upload", "dog.mem", "--to", served["url"]).code == 3


def test_upload_to_a_device(voxrt):
    assert voxrt("build", "house.obj", "--depth", 4).code == 0
    finished = voxrt("upload", "house.mem", "--device", "model")
    assert (finished.code, finished.out) == (0, "")
    assert "house.mem: loaded" in finished.err


def test_upload_to_the_simulated_hardware(voxrt):
    pytest.importorskip("voxrt.sim._rtl")
    assert voxrt("build", "house.obj", "--depth", 4).code == 0
    for config in ("tiny", "lit"):
        finished = voxrt.succeeds("upload", "house.mem", "--device", "sim", "--config", config)
        assert "house.mem: loaded" in finished.err
    for command in (("upload", "house.mem", "--device", "sim"), ("serve", "--device", "sim"), ("render", "house.mem")):
        voxrt.fails(2, "no ray tracer configuration 'huge'; there are ", *command, "--config", "huge")


def test_a_server_on_the_simulated_hardware(folder):
    pytest.importorskip("voxrt.sim._rtl")
    with serving(folder, "house.obj", "--depth", "4", "--device", "sim") as served:
        assert served["url"]


@pytest.fixture
def board(monkeypatch):
    """The address of an agent with a token, which the environment has too."""
    pytest.importorskip("voxrt.sim._rtl")
    install(monkeypatch, Core())
    monkeypatch.setenv("VOXRT_BOARD_TOKEN", "a token")
    with running_agent("a token") as (address, _):
        yield address


def test_a_server_on_a_board_shows_what_the_model_shows(folder, board):
    async def picture(url):
        async with open_client(url) as client:
            await client.take_control()
            await client.request("view", size=[64, 48])
            number = await client.send("show", scene="house")
            while (await client._answer(number))["type"] != "done":
                pass
            while (packet := await client.next_frame()).scene != 1:
                pass
            return client.hello["device"]["name"], packet.frame.colour

    found = []
    for device in (board, "model"):
        with serving(folder, "--depth", "4", "--device", device) as served:
            found.append(asyncio.run(asyncio.wait_for(picture(served["url"]), 300)))
    (name, colour), (_, expected) = found
    assert name == f"board at {board.removeprefix('tcp://')}, 1 lane"
    assert (colour == expected).all()
    assert len(np.unique(colour.reshape(-1, 3), axis=0)) > 4


def test_upload_to_a_board(voxrt, folder, board, monkeypatch):
    assert voxrt("build", "house.obj", "--depth", 4).code == 0
    for options, done in (([], "loaded"), (["--dry-run"], "checked; nothing was written")):
        finished = voxrt.succeeds("upload", "house.mem", "--to", board, *options)
        assert f"house.mem: {done}" in finished.err
    (folder / "wide.blob").write_bytes(blob_of(wide_scene("wide", 3000)))
    voxrt.fails(4, "wide has 24001 words and board at 127", "upload", "wide.blob", "--to", board)
    monkeypatch.setenv("VOXRT_BOARD_TOKEN", "another")
    voxrt.fails(5, "the token is another one", "upload", "house.mem", "--to", board)


def test_the_line_of_a_board_stays_open_for_all_files_of_standard_input(voxrt, folder):
    pytest.importorskip("voxrt.sim._rtl")
    assert voxrt("build", "house.obj", "--depth", 4).code == 0
    for number in (1, 2):
        script = [{"op": "set", "points": [[number, height, 1]], "materials": 1} for height in range(16)]
        (folder / "edits.jsonl").write_text("".join(f"{json.dumps(one)}\n" for one in script))
        voxrt.succeeds("edit", "house.mem", "--script", "edits.jsonl", "-o", f"edited{number}.mem")
    board = Board()
    get, put, opened, written = board.get, board.put, [], []
    board.get = lambda address: (opened.append(address == 0x1000), get(address))[1]
    board.put = lambda address, value: (written.append(address >= 0x800000), put(address, value))[1]
    with serial_line(board) as address:
        command = [sys.executable, "-m", "voxrt", "upload", "-", "--json", "--to", address]
        pipes = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.PIPE)
        with subprocess.Popen(command, cwd=folder, text=True, **pipes) as process:
            taken = []
            for file in ("house.mem", "edited1.mem", "nothing.mem", "edited2.mem"):
                written.clear()
                process.stdin.write(f"{file}\n")
                process.stdin.flush()
                if file == "nothing.mem":
                    assert "nothing.mem: cannot be read" in process.stderr.readline()
                    continue
                answer = "".join(iter(process.stdout.readline, "}\n"))
                assert f'"name": "{file.removesuffix(".mem")}"' in answer
                taken.append(sum(written))
            _, errors = process.communicate(timeout=60)
    assert (process.returncode, errors) == (5, "voxrt: error: 1 of 4 memories were not shown\n")
    assert sum(opened) == 1
    first, *edits = taken
    assert 0 < max(edits) < first / 4
    shown = SerialDevice(SerialLink("test port", board), ModelDevice()).loaded().scene
    expected = read_any(folder / "edited2.mem")[0].rom.octree
    np.testing.assert_array_equal(to_dense(Octree(shown.depth, shown.words)), to_dense(expected))


def test_a_server_for_others_wants_a_token(folder):
    with serving(folder, "--host", "0.0.0.0") as served:
        assert "#token=" in served["url"]


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (["serve", "--port", "65536"], 2, "--port must be an integer 0 … 65535, not 65536"),
        (["serve", "--depth", "17"], 2, "--depth must be an integer 1 … 16, not 17"),
        (["serve", "--device", "abacus"], 2, "there are model, sim, serial:PORT and tcp://BOARD:PORT"),
        (["serve", "--device", "tcp://board"], 5, "tcp://board is no address of a board; name it as tcp://BOARD:PORT"),
        (["serve", "--device", "tcp://127.0.0.1:1"], 5, "127.0.0.1:1 does not answer"),
        (["serve", "nothing.mem"], 3, "nothing.mem"),
        (["serve", "nothing.blob"], 3, "nothing.blob"),
        (["upload", "house.obj", "--to", "127.0.0.1:1"], 2, "is no .mem or .blob; build it first"),
        (["upload", "nothing.mem", "--to", "127.0.0.1:1"], 3, "nothing.mem"),
        (["upload", "nothing.mem"], 2, "give one of them"),
    ],
)
def test_errors(voxrt, arguments, code, message):
    voxrt.fails(code, message, *arguments)
