"""The protocol of the agent, byte by byte over loopback: who is let in, what is refused, and what frees the board."""

from __future__ import annotations

import hmac
import socket
import struct
import sys
import threading

import numpy as np
import pytest
from fakes.agent_client import TOKEN, client
from fakes.board_agent import running_agent
from fakes.pynq import Core, install

from voxrt.board import tcp_device
from voxrt.board.agent import voxrt_board
from voxrt.board.errors import DeviceError
from voxrt.board.registers import REGISTERS
from voxrt.board.tcp_device import open_tcp

WORDS = 0x10000 // 4
LEAVES = struct.pack("<2I", 0xFFFFFF06, 0xFFFFFF07)


@pytest.fixture
def core(monkeypatch):
    pytest.importorskip("voxrt.sim._rtl", reason="the verilated core is not in this installation")
    core = Core()
    install(monkeypatch, core)
    return core


@pytest.fixture
def agent(core, monkeypatch):  # noqa: ARG001 - it is in the board
    monkeypatch.setattr(voxrt_board, "VDMA_SECONDS", 0.5)
    with running_agent(TOKEN) as (address, _):
        yield address


def test_the_greeting(agent):
    with client(agent) as one:
        assert one.greeting[:12] == b"VXRTAGNT\1\0\0\0"
        assert one.prove() == (0, struct.pack("<5I", WORDS, 0, 1920, 1080, 8))
        assert one.ask(0) == (0, b"")
        assert one.ask(1, 1, 0, bytes(8)) == (0, b"TRXV")
    with client(agent) as other:
        assert other.greeting[12:] != one.greeting[12:]


def test_who_is_not_let_in(agent):
    for token in ("", "another"):
        with client(agent) as one:
            status, problem = one.prove(token)
            assert status == 1
            assert problem.startswith(b"the token is another one; ")
            assert one.answer() is None
        with pytest.raises(DeviceError, match=r"^127\.0\.0\.1:\d+: the token is another one; "):
            open_tcp(agent, token)
    with client(agent) as one, client(agent) as replay:
        one.prove()
        replay.line.sendall(hmac.digest(TOKEN.encode(), one.greeting[12:], "sha256"))
        assert replay.answer()[0] == 1
    open_tcp(agent, TOKEN).close()


def test_one_client_at_a_time(agent):
    device = open_tcp(agent, TOKEN)
    with pytest.raises(DeviceError, match="another client uses the board; end it"):
        open_tcp(agent, TOKEN)
    assert device.registers()["identity"] == int.from_bytes(b"VXRT", "big")
    device.close()
    open_tcp(agent, TOKEN).close()


@pytest.mark.parametrize(
    ("request_of", "problem"),
    [
        ((2, WORDS - 1, 2), f"words {WORDS - 1} to {WORDS + 1} are not in a memory of {WORDS}"),
        ((2, 0xFFFFFFFF, 1), "words 4294967295 to 4294967296 are not in"),
        ((3, WORDS, 1, bytes(4)), f"words {WORDS} to {WORDS + 1} are not in"),
        ((1, 1, 0, struct.pack("<2I", 0x10000, 0)), "the ray tracer has no register at 0x10000"),
        ((1, 1, 0, struct.pack("<2I", 0xFFFFFFFD, 0)), "the ray tracer has no register at 0xFFFFFFFC"),
        ((1, 1, 0, struct.pack("<2I", 2, 0)), "the ray tracer has no register at 0x2"),
        ((4, 0, 8), "no frame has 0x8 pixels"),
        ((4, 1928, 8), "no frame has 1928x8 pixels"),
        ((4, 8, 1081), "no frame has 8x1081 pixels"),
        ((4, 12, 8), "no frame has 12x8 pixels"),
    ],
)
def test_what_is_refused_leaves_the_connection(agent, request_of, problem):
    with client(agent) as one:
        one.prove()
        status, text = one.ask(*request_of)
        assert (status, text[: len(problem)]) == (1, problem.encode())
        assert one.ask(3, 5, 2, LEAVES) == (0, b"")
        assert one.ask(2, 5, 2) == (0, LEAVES)


@pytest.mark.parametrize("request_of", [(6,), (2**32 - 1,), (1, 2**15 + 1), (2, 0, 2**16 + 1), (3, 0, 2**32 - 1)])
def test_requests_that_are_unknown_or_too_large_end_the_connection(agent, request_of):
    with client(agent) as one:
        one.prove()
        status, problem = one.ask(*request_of)
        assert (status, problem[:43]) == (1, b"the request is unknown or too large; update")
        assert one.answer() is None
    open_tcp(agent, TOKEN).close()


def test_a_connection_that_is_cut_frees_the_board(agent):
    for cut in (b"", b"\1", struct.pack("<3I", 3, 0, 100) + bytes(12), struct.pack("<3I", 5, 0, 0)):
        with client(agent) as one:
            one.prove()
            one.line.sendall(cut)
    with client(agent) as one:
        assert one.prove()[0] == 0
        assert one.ask(4, 64, 48) == (0, b"")
    open_tcp(agent, TOKEN).close()


def test_clients_that_send_nothing_are_left(agent, monkeypatch):
    monkeypatch.setattr(voxrt_board, "PROOF_SECONDS", 0.05)
    with client(agent) as one:
        one.line.sendall(bytes(31))
        assert one.answer() is None
    monkeypatch.setattr(voxrt_board, "PROOF_SECONDS", 30)
    monkeypatch.setattr(voxrt_board, "IDLE_SECONDS", 0.05)
    for beginning in (b"", struct.pack("<3I", 3, 0, 2) + bytes(7)):
        with client(agent) as one:
            one.prove()
            one.line.sendall(beginning)
            assert one.answer() is None


def test_guests_that_stall_keep_nobody_out(agent, monkeypatch):
    monkeypatch.setattr(voxrt_board, "PROOF_SECONDS", 30)
    with client(agent), client(agent), client(agent) as one:
        one.line.sendall(bytes(31))
        open_tcp(agent, TOKEN).close()


def test_a_token_that_is_no_text_is_another_one(agent):
    with pytest.raises(DeviceError, match="the token is another one"):
        open_tcp(agent, "\udcff")


@pytest.mark.usefixtures("core")
def test_guests_are_few(monkeypatch):
    monkeypatch.setattr(voxrt_board, "GUESTS", 1)
    with running_agent() as (address, _):
        with client(address) as one:
            with client(address) as other:
                assert other.greeting is None
            assert one.prove("")[0] == 0
        open_tcp(address, "").close()


@pytest.mark.usefixtures("core")
def test_an_idle_client_stays(monkeypatch):
    monkeypatch.setattr(tcp_device, "_KEEP_SECONDS", 0.01)
    with running_agent() as (address, board):
        execute, idle = board.execute, threading.Semaphore(0)

        def count(operation, *rest):
            if operation == voxrt_board.NOTHING:
                idle.release()
            return execute(operation, *rest)

        monkeypatch.setattr(board, "execute", count)
        device = open_tcp(address, "")
        for _ in range(3):
            assert idle.acquire(timeout=30)
        assert device.registers()["identity"] > 0
        device.close()


def test_the_memory_in_bursts(agent, monkeypatch):
    monkeypatch.setattr(tcp_device, "_BURST", 100)
    device = open_tcp(agent, TOKEN)
    words = np.random.default_rng(1).integers(0xFFFFFF00, 1 << 32, 1001, dtype=np.uint32)
    device.write_memory(9, words)
    assert (device.read_memory(9, 1001) == words).all()
    assert len(device.read_memory(9, 0)) == 0
    with pytest.raises(DeviceError, match="are not in a memory of"):
        device.write_memory(WORDS - 1, words)
    device.close()


def test_registers_of_a_frame_come_in_one_message(agent):
    device = open_tcp(agent, TOKEN)
    operations, link = [], device._registers._link
    ask = link.ask
    link.ask = lambda operation, *rest, **named: operations.append(operation) or ask(operation, *rest, **named)
    assert list(device.registers()) == list(REGISTERS)
    device.write_materials(np.zeros((256, 3), np.uint8), np.zeros(256, bool))
    assert operations == [1, 1, 1, 1]  # all registers; hold, its status, the table
    device.close()


@pytest.mark.parametrize(
    ("sent", "problem"),
    [
        (b"", "is no agent of voxrt-board"),
        (b"HTTP/1.1 400 Bad Request\r\n\r\n", "is no agent of this version"),
        (struct.pack("<8sI16s", b"VXRTAGNT", 2, b""), "is no agent of this version"),
        (struct.pack("<8sI16s", b"VXRTAGNT", 1, b"") + struct.pack("<2I", 0, 1 << 31), "is no agent of voxrt-board"),
        (struct.pack("<8sI16s", b"VXRTAGNT", 1, b"") + struct.pack("<2I", 1, 1 << 31), "is no agent of voxrt-board"),
    ],
)
def test_what_is_no_agent(sent, problem):
    with socket.create_server(("127.0.0.1", 0)) as listener:

        def serve():
            connection, _ = listener.accept()
            with connection:
                connection.sendall(sent)
                connection.shutdown(socket.SHUT_WR)
                while connection.recv(100):
                    pass

        thread = threading.Thread(target=serve)
        thread.start()
        with pytest.raises(DeviceError, match=rf"^127\.0\.0\.1:\d+ {problem}"):
            open_tcp(f"tcp://127.0.0.1:{listener.getsockname()[1]}", "")
        thread.join(30)


def test_an_agent_that_ends(agent):
    device = open_tcp(agent, TOKEN)
    device._registers._link._socket.shutdown(socket.SHUT_RDWR)
    for _ in range(2):
        with pytest.raises(DeviceError, match=r"^the connection to 127\.0\.0\.1:\d+ is lost .*; see that voxrt-board"):
            device.registers()


@pytest.mark.parametrize(
    "address",
    ["tcp://", "tcp://host", "tcp://host:99999", "tcp://[::1", "tcp://:1", "tcp://host:1/scene", "tcp://me@host:1"],
)
def test_what_is_no_address(address):
    with pytest.raises(DeviceError, match="is no address of a board; name it as tcp://BOARD:PORT"):
        open_tcp(address, "")


def token_of(monkeypatch, *arguments):
    """What `voxrt-board` with these arguments takes for its token."""
    tokens = []

    def serve(_listener, _board, token):
        tokens.append(token)
        raise KeyboardInterrupt

    monkeypatch.setattr(voxrt_board, "serve", serve)
    monkeypatch.setattr(sys, "argv", ["voxrt-board", "voxrt.bit", "--port", "0", *arguments])
    voxrt_board.main()
    return tokens[0]


def test_tokens(core, monkeypatch, tmp_path, capsys):
    """A token is compulsory on all addresses but loopback, and one that is made is shown."""
    install(monkeypatch, core, contiguous=1 << 26)
    mine, empty = tmp_path / "mine", tmp_path / "empty"
    mine.write_text("mine\nrest\n")
    empty.write_text("\n")
    assert token_of(monkeypatch) == ""
    assert token_of(monkeypatch, "--token-file", str(mine)) == "mine"
    assert token_of(monkeypatch, "--token-file", str(mine), "--host", "0.0.0.0") == "mine"
    assert "VOXRT_BOARD_TOKEN" not in capsys.readouterr().out
    mine.write_bytes(b"\xff")
    with pytest.raises(SystemExit, match=r"^voxrt-board: error: 'utf-8' codec can't decode"):
        token_of(monkeypatch, "--token-file", str(mine))
    for arguments in (("--host", "0.0.0.0"), ("--token-file", str(empty))):
        token = token_of(monkeypatch, *arguments)
        assert len(token) > 20
        assert f"VOXRT_BOARD_TOKEN={token}\n" in capsys.readouterr().out
