"""``voxrt upload`` and servers that misbehave: one line within a time limit, and never a fault of voxrt."""

from __future__ import annotations

import asyncio
import json
import socket
import threading

import numpy as np
import pytest
from fakes.blob import blob_of
from fakes.device import scene
from websockets.asyncio.server import serve

from voxrt.cli.run import run as voxrt
from voxrt.serve import frame_client
from voxrt.serve.packets import unpack_frame

HELLO = {"type": "hello", "protocol": 2, "viewer": 1, "device": {"name": "d", "capacity": 1 << 20, "depth": 16}}


def answers(*replies):
    """A WebSocket server that says hello, and then one reply per message, with its request number."""

    async def handle(connection):
        await connection.send(json.dumps(HELLO))
        waiting = list(replies)
        async for message in connection:
            number = json.loads(message)["request"] if isinstance(message, str) else 2
            if waiting:
                reply = waiting.pop(0)
                text = json.dumps({"request": number, **reply}) if isinstance(reply, dict) else reply
                await connection.send(text)

    return handle


def says(*messages):
    async def handle(connection):
        for message in messages:
            await connection.send(message)
        await connection.wait_closed()

    return handle


GRANTED = {"type": "done", "granted": True}
READY = {"type": "ready", "upload": 2}


@pytest.mark.parametrize(
    ("handle", "problem"),
    [
        (says(), "the server does not answer within"),
        (says(b"\xff" * 100), "does not understand"),
        (says("[]"), "does not understand"),
        (says("{" * 100_000), "does not understand"),
        (says('{"type": "hello", "protocol": "\\u202e' + "9" * 1000 + '"}'), "has protocol version"),
        (says('{"type": "hello", "protocol": 2}'), "does not understand"),
        (says(json.dumps({**HELLO, "device": {"capacity": "many"}})), "does not understand"),
        (says(json.dumps(HELLO)), "the server does not answer within"),
        (answers({}), "does not understand"),
        (answers({"type": "done"}), "another viewer has control"),
        (answers("nothing"), "does not understand"),
        (answers(b"VXFR"), "the message is no frame"),
        (answers(b"VXFR" + bytes(100)), "connect again"),
        (answers(GRANTED, {"type": "refused"}), "None"),
        (answers(GRANTED, {"type": "refused", "problem": "a\nb\x1b[2J"}), "a\\x0ab\\x1b[2J"),
        (answers(GRANTED, {"type": "ready"}), "does not understand"),
        (answers(GRANTED, READY), "the server does not answer within"),
        (answers(GRANTED, READY, {"type": "progress", "stage": ["["], "done": -1, "total": None}), "not understand"),
        (answers(GRANTED, READY, {"type": "received", "bytes": 1e300}), "not understand"),
    ],
)
def test_what_servers_do_wrong(tmp_path, capsys, monkeypatch, handle, problem):
    monkeypatch.setattr(frame_client, "_OPEN_SECONDS", 3.0)
    monkeypatch.setattr(frame_client, "_ANSWER_SECONDS", 1.0)
    (tmp_path / "x.blob").write_bytes(blob_of(scene("x")))
    ready, ended, port = threading.Event(), asyncio.Event(), []
    loop = asyncio.new_event_loop()

    async def listen():
        async with serve(handle, "127.0.0.1", 0, close_timeout=0.1) as server:
            port.append(server.sockets[0].getsockname()[1])
            ready.set()
            await ended.wait()

    thread = threading.Thread(target=lambda: loop.run_until_complete(listen()))
    thread.start()
    try:
        assert ready.wait(60)
        assert voxrt(["upload", str(tmp_path / "x.blob"), "--to", f"127.0.0.1:{port[0]}"]) == 5
    finally:
        loop.call_soon_threadsafe(ended.set)
        thread.join(60)
        loop.close()
    message = capsys.readouterr().err
    assert problem in message
    assert "bug" not in message
    assert message.count("\n") == 1


@pytest.mark.parametrize("listens", [True, False])
def test_what_is_no_server(tmp_path, capsys, monkeypatch, listens):
    """A port where nobody answers, and one where nobody listens."""
    monkeypatch.setattr(frame_client, "_OPEN_SECONDS", 0.5)
    (tmp_path / "x.blob").write_bytes(blob_of(scene("x")))
    with socket.create_server(("127.0.0.1", 0)) as silent:
        port = silent.getsockname()[1] if listens else 1
        assert voxrt(["upload", str(tmp_path / "x.blob"), "--to", f"127.0.0.1:{port}"]) == 5
    assert "no frame server answers" in capsys.readouterr().err


@pytest.mark.parametrize("url", ["http://[::1", "ftp://a/", "http://a:99999/", "http://", "http:///x", "ws://a:0/"])
def test_what_is_no_address(tmp_path, capsys, url):
    (tmp_path / "x.blob").write_bytes(blob_of(scene("x")))
    assert voxrt(["upload", str(tmp_path / "x.blob"), "--to", url]) == 5
    assert "is no address such as" in capsys.readouterr().err


def test_frames_of_noise():
    random = np.random.default_rng(3)
    for _ in range(2000):
        message = b"VXFR" + random.bytes(int(random.integers(0, 120)))
        with pytest.raises(frame_client.Refused):
            unpack_frame(message)
