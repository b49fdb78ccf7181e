"""Tasks on several processes of this machine.

On Linux the processes are forks of this one: they have its modules and its data, and load neither. Elsewhere they are
new processes. One that is killed takes the others with it; the tasks that are left go to new ones.
"""

from __future__ import annotations

import os
import signal
import sys
import tempfile
import warnings
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing import get_context
from tempfile import TemporaryDirectory
from threading import Thread
from typing import TYPE_CHECKING, Any, TypeVar

from voxrt.errors import ToolError
from voxrt.plans.workers import Workers, attempt, checked

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from concurrent.futures import Future
    from multiprocessing.connection import Connection

    from voxrt.plans.workers import Failure

T = TypeVar("T")

_FORK = sys.platform == "linux"
_MOST_LOST = 3
"""After so many kills without a finished task between them, this gives up."""

_ENDING = (signal.SIGTERM, getattr(signal, "SIGHUP", signal.SIGTERM))

_shared: list[object] = []
"""In a worker: the first arguments of its tasks."""


class LocalWorkers(Workers):
    """So many processes of this machine, each of which does one task at a time."""

    def completed(
        self,
        task: Callable[..., T],
        calls: Sequence[tuple[object, ...]],
        shared: tuple[object, ...] = (),
        waiting: Callable[[], None] | None = None,  # noqa: ARG002 - a process of this machine that ends is noticed
    ) -> Iterator[tuple[int, T]]:
        """Do tasks, those of killed processes again."""
        left, lost = dict(enumerate(calls)), 0
        while left:
            try:
                with _submitted(task, shared, left, self.count) as futures:
                    for future in as_completed(futures):
                        number, result = futures[future], future.result()
                        del left[number]
                        lost = 0
                        yield number, checked(result)
            except BrokenProcessPool:
                lost += 1
                if lost == _MOST_LOST:
                    raise ToolError(
                        f"processes of this machine were killed {lost} times, perhaps for want of memory; take fewer "
                        "--workers, or a smaller --memory"
                    ) from None


@contextmanager
def _submitted(
    task: Callable[..., T], shared: tuple[object, ...], calls: dict[int, tuple[object, ...]], workers: int
) -> Iterator[dict[Future[T | Failure], int]]:
    """Start processes and submit calls by number; the processes end with the block, or with this process."""
    context: Any = get_context("fork" if _FORK else "spawn")
    alive, own = context.Pipe(duplex=False)  # closes when this process has ended, in whichever way
    with TemporaryDirectory(prefix="voxrt-") as scratch, alive, own:
        pool = ProcessPoolExecutor(
            min(workers, len(calls)),
            mp_context=context,
            initializer=_begin,
            initargs=(alive, own if _FORK else None, scratch, shared),
        )
        try:
            with _held_back(), warnings.catch_warnings(action="ignore", category=DeprecationWarning):
                futures = {pool.submit(_call, task, one): number for number, one in calls.items()}
            yield futures
        except BaseException:
            own.close()  # which ends all processes now
            raise
        finally:
            pool.shutdown(cancel_futures=True)


@contextmanager
def _held_back() -> Iterator[None]:
    """Hold back signals while processes start, until these say what they do at a signal."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT, *_ENDING])
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _begin(alive: Connection, own: Connection | None, scratch: str, shared: tuple[object, ...]) -> None:
    """Begin a worker: give up what a fork has of the process that it is a fork of."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for that process
    for number in _ENDING:
        if callable(signal.getsignal(number)):
            signal.signal(number, signal.SIG_DFL)
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGINT, *_ENDING])
    if own is not None:
        own.close()
    Thread(target=_end_with, args=(alive,), daemon=True).start()
    os.environ["TMPDIR"] = tempfile.tempdir = scratch  # what a killed worker leaves goes with it
    _shared[:] = shared


def _end_with(alive: Connection) -> None:
    try:
        alive.recv()
    finally:
        os._exit(1)


def _call(task: Callable[..., T], call: tuple[object, ...]) -> T | Failure:
    return attempt(task, *_shared, *call)
