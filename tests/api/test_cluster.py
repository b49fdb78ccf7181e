"""Builds on a cluster: the bytes of one machine, whatever happens to its workers; a lost scheduler is one line."""

from __future__ import annotations

import multiprocessing
import os
import signal
import socket
import subprocess
import sys
import threading
from contextlib import contextmanager, nullcontext, suppress
from pathlib import Path

import pytest
from oracles.meshes import icosphere

import voxrt
from voxrt.plans.local_workers import LocalWorkers
from voxrt.plans.tile_store import TileStore

distributed = pytest.importorskip("distributed")

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
DEPTH = 11
LIMIT = 120.0
"""Seconds that anything may take here."""

pytestmark = [
    pytest.mark.filterwarnings("ignore"),  # those of Dask and its libraries
    pytest.mark.skipif(not hasattr(signal, "pthread_sigmask"), reason="no POSIX system"),
]

# Starts the command in a process group of its own, and sends the group a signal once a tile is there.
INTERRUPTED = """
import os, signal, subprocess, sys, time
from pathlib import Path
number, folder = int(sys.argv[1]), Path(sys.argv[2])
child = subprocess.Popen(sys.argv[3:], start_new_session=True, stderr=subprocess.PIPE)
end = time.monotonic() + 100
while not list(folder.glob("*.tile")) and child.poll() is None and time.monotonic() < end:
    os.sched_yield()
os.killpg(child.pid, number)
_, errors = child.communicate(timeout=100)
sys.stderr.buffer.write(errors)
sys.exit(child.returncode)
"""


@contextmanager
def scheduler(folder, workers):
    """A scheduler of its own process, and so many workers; yields its address and the processes."""
    started = []

    def start(program, *arguments):
        command = [sys.executable, "-m", f"distributed.cli.{program}", *map(str, arguments)]
        started.append(
            subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        )
        return started[-1]

    try:
        main = start("dask_scheduler", "--host", "127.0.0.1", "--port", 0, "--no-dashboard")
        address = next(line.split()[-1] for line in main.stderr if "Scheduler at:" in line)
        for _ in range(workers):
            worker = start(
                "dask_worker", address, "--no-nanny", "--no-dashboard", "--nthreads", 1, "--memory-limit", 0,
                "--local-directory", folder,
            )  # fmt: skip
            next(line for line in worker.stderr if "Registered to" in line)
        yield address, started
    finally:
        for process in reversed(started):
            process.kill()
            process.wait(LIMIT)
            process.stderr.close()


@pytest.fixture(scope="module")
def alone(tmp_path_factory):
    folder = tmp_path_factory.mktemp("alone")
    return voxrt.build(EXAMPLES / "dog.usda", folder / "dog.mem", depth=DEPTH)


def same(built, alone):
    assert bytes(built.octree.words) == bytes(alone.octree.words)
    assert built.objects == alone.objects
    assert built.warnings == alone.warnings
    assert built.outputs["mem"].read_bytes() == alone.outputs["mem"].read_bytes()
    assert sorted(path.name for path in built.outputs["mem"].parent.iterdir()) == ["dog.json", "dog.mem"]


@pytest.mark.parametrize("on_a_cluster", [False, True])
def test_squares_of_tiles_that_workers_join_give_the_same_bytes(on_a_cluster, tmp_path, monkeypatch):
    names = []
    join = TileStore.join

    def look(store, pieces, *others):
        names.extend(pieces)
        return join(store, pieces, *others)

    monkeypatch.setattr("voxrt.plans.by_workers.JOINERS", 1)
    monkeypatch.setattr("voxrt.plans.by_workers._TILES_PER_WORKER", 32)
    monkeypatch.setattr(TileStore, "join", look)
    asset = tmp_path / "ball.obj"
    ball = icosphere(2, (0.0, 0.0, 0.0), 1.0)
    lines = [f"v {x} {y} {z}" for x, y, z in ball.positions]
    lines += [f"f {a} {b} {c}" for a, b, c in ball.triangles + 1]
    asset.write_text("\n".join(lines))
    options = {"depth": 12, "fill": "surface"}
    one = voxrt.build(asset, tmp_path / "1" / "ball.mem", **options)
    with scheduler(tmp_path, 2) if on_a_cluster else nullcontext((None, [])) as (address, _):
        where = {"scheduler": address} if on_a_cluster else {"workers": 2}
        two = voxrt.build(asset, tmp_path / "2" / "ball.mem", **where, **options)
    assert len(names) == 4
    assert all(name.startswith("joined-1-") for name in names)
    assert bytes(two.octree.words) == bytes(one.octree.words)
    assert two.objects == one.objects


@pytest.mark.parametrize("workers", [1, 2, 4])
def test_workers_give_the_bytes_of_one_machine(workers, alone, tmp_path):
    reports = []
    built = voxrt.build(
        EXAMPLES / "dog.usda", tmp_path / "dog.mem", depth=DEPTH, workers=workers, clustered=reports.append
    )
    same(built, alone)
    assert [one.done for one in reports] == list(range(1, reports[-1].tiles + 1))
    assert {one.workers for one in reports} == {workers}
    assert reports[-1].bytes > 0


def test_a_worker_that_is_killed_is_survived(alone, tmp_path):
    out = tmp_path / "out"
    with scheduler(tmp_path, 2) as (address, processes):

        def kill(progress):
            if progress.done == 1:
                processes[1].kill()

        built = voxrt.build(EXAMPLES / "dog.usda", out / "dog.mem", depth=DEPTH, scheduler=address, clustered=kill)
    same(built, alone)


def test_a_process_of_this_machine_that_is_killed_is_survived(alone, tmp_path):
    killed = []

    def kill(progress):
        if progress.done in (1, 3):
            killed.append(multiprocessing.active_children()[0])
            killed[-1].kill()

    built = voxrt.build(EXAMPLES / "dog.usda", tmp_path / "dog.mem", depth=DEPTH, workers=2, clustered=kill)
    assert len(killed) == 2
    same(built, alone)


def test_processes_that_are_killed_again_and_again_are_one_line():
    with pytest.raises(voxrt.ToolError, match="were killed 3 times") as lost:
        list(LocalWorkers(2).completed(end_this_process, [()]))
    assert "\n" not in str(lost.value)


def end_this_process():
    os._exit(1)


def test_a_lost_scheduler_is_one_line_and_its_tiles_are_used_again(alone, tmp_path):
    out = tmp_path / "out"
    with scheduler(tmp_path, 1) as (address, processes):

        def kill(_progress):
            processes[0].kill()

        with pytest.raises(voxrt.ToolError, match=r"^the cluster is lost .* finished tiles stay") as lost:
            voxrt.build(EXAMPLES / "dog.usda", out / "dog.mem", depth=DEPTH, scheduler=address, clustered=kill)
    assert "\n" not in str(lost.value)
    tiles = list((out / "dog.tiles").glob("*.tile"))
    assert tiles
    before = {path: path.stat().st_mtime_ns for path in tiles}
    touched = {}

    def look(_progress):
        for path in before:
            touched[path] = path.stat().st_mtime_ns

    built = voxrt.build(EXAMPLES / "dog.usda", out / "dog.mem", depth=DEPTH, workers=1, clustered=look)
    assert touched == before
    same(built, alone)


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_an_interrupted_cluster_leaves_tiles_and_nothing_else(number, code, alone, tmp_path):
    out, scratch = tmp_path / "out", tmp_path / "scratch"
    scratch.mkdir()
    command = [sys.executable, "-m", "voxrt", "build", EXAMPLES / "dog.usda", "-o", out / "dog.mem"]
    command += ["--depth", DEPTH, "--workers", 2]
    finished = subprocess.run(
        [sys.executable, "-c", INTERRUPTED, str(int(number)), out / "dog.tiles", *map(str, command)],
        cwd=scratch,
        env={**os.environ, "TMPDIR": str(scratch)},
        capture_output=True,
        text=True,
        check=False,
        timeout=2 * LIMIT,
    )
    assert finished.returncode == code, finished.stderr
    assert finished.stderr.splitlines()[-1].endswith("every file is as it was, or complete")
    assert "Traceback" not in finished.stderr
    left = [path.name for path in (out / "dog.tiles").iterdir()]
    assert "key" in left
    assert [name for name in left if name != "key" and not name.endswith(".tile")] == []
    assert list(scratch.iterdir()) == []
    same(voxrt.build(EXAMPLES / "dog.usda", out / "dog.mem", depth=DEPTH, workers=1), alone)


def test_a_scheduler_that_is_not_there_is_one_line(tmp_path, monkeypatch):
    monkeypatch.setattr("voxrt.plans.dask_workers._WAIT", 0.5)
    with pytest.raises(voxrt.ToolError, match=r"tcp://127.0.0.1:9: no scheduler with a worker answers") as refused:
        voxrt.build(EXAMPLES / "dog.usda", tmp_path / "dog.mem", depth=DEPTH, scheduler="tcp://127.0.0.1:9")
    assert "\n" not in str(refused.value)


@pytest.mark.skipif(not hasattr(signal, "SIGSTOP"), reason="stops a process as POSIX does")
def test_a_worker_that_is_stopped_is_told(alone, tmp_path, monkeypatch):
    monkeypatch.setattr("voxrt.plans.dask_workers._SILENCE", 2.0)
    with scheduler(tmp_path, 1) as (address, processes):
        reports = []

        def look(progress):
            reports.append(progress.silent)
            if len(reports) == 1:
                processes[1].send_signal(signal.SIGSTOP)
            elif progress.silent:
                processes[1].send_signal(signal.SIGCONT)

        built = voxrt.build(
            EXAMPLES / "dog.usda", tmp_path / "out" / "dog.mem", depth=DEPTH, scheduler=address, clustered=look
        )
    assert 1 in reports
    same(built, alone)


@contextmanager
def answering(data):
    """A port that accepts, sends `data`, and says no more."""
    with socket.create_server(("127.0.0.1", 0)) as port:
        accepted = []

        def accept():
            with suppress(OSError):
                while True:
                    accepted.append(port.accept()[0])
                    accepted[-1].sendall(data)

        thread = threading.Thread(target=accept, daemon=True)
        thread.start()
        yield f"127.0.0.1:{port.getsockname()[1]}"
        port.shutdown(socket.SHUT_RDWR)
        thread.join(LIMIT)
        for one in accepted:
            one.close()


@pytest.mark.parametrize(
    ("data", "problem"),
    [
        (b"", "nothing came within 2 s"),
        (b"HTTP/1.1 200 OK\r\nContent-Length: 5\r\n\r\nhello", "something else is there"),
        (bytes(range(256)) * 20, "something else is there"),
        (b"\xff" * 64, "no scheduler"),
    ],
)
def test_a_port_where_no_scheduler_is_is_one_line(tmp_path, monkeypatch, data, problem):
    monkeypatch.setattr("voxrt.plans.dask_workers._WAIT", 2.0)
    with answering(data) as address, pytest.raises(voxrt.ToolError, match=problem) as refused:
        voxrt.build(EXAMPLES / "dog.usda", tmp_path / "dog.mem", depth=DEPTH, scheduler=f"tcp://{address}")
    assert "\n" not in str(refused.value)


def test_tls_without_certificates_is_one_line(tmp_path):
    with pytest.raises(voxrt.ToolError, match="Dask has no certificates for TLS; name them in Dask's configuration"):
        voxrt.build(EXAMPLES / "dog.usda", tmp_path / "dog.mem", depth=DEPTH, scheduler="tls://127.0.0.1:9")


def test_a_worker_that_finds_another_asset_is_refused(tmp_path):
    asset = tmp_path / "one.obj"
    asset.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")

    def change(_estimate):
        asset.write_text(asset.read_text().replace("v 0 0 1", "v 0 0 2"))

    with (
        scheduler(tmp_path, 1) as (address, _),
        pytest.raises(voxrt.ToolError, match="a worker has another file, or another version"),
    ):
        voxrt.build(asset, tmp_path / "one.mem", depth=DEPTH, scheduler=address, estimated=change)


def test_what_a_cluster_cannot_build_is_refused(tmp_path):
    scene = voxrt.load(EXAMPLES / "house.obj")
    with pytest.raises(TypeError, match="open the asset's file"):
        voxrt.build(scene, tmp_path, depth=DEPTH, workers=2)
    with pytest.raises(ValueError, match="name an output"):
        voxrt.build(EXAMPLES / "house.obj", depth=DEPTH, workers=2)
    with pytest.raises(ValueError, match="exclude each other"):
        voxrt.build(EXAMPLES / "house.obj", tmp_path, workers=2, scheduler="tcp://127.0.0.1:1")
    with pytest.raises(ValueError, match="workers"):
        voxrt.BuildOptions(workers=0)


def test_an_unsound_asset_is_refused_as_on_one_machine(tmp_path):
    broken = tmp_path / "broken.obj"
    broken.write_text("v 0 0\nf 1 1 1\n")
    messages = []
    for options in ({}, {"workers": 1}):
        with pytest.raises(voxrt.AssetError) as refused:
            voxrt.build(broken, tmp_path / "out", depth=DEPTH, **options)
        messages.append(str(refused.value))
    assert messages[0] == messages[1]
    assert not (tmp_path / "out").exists()
