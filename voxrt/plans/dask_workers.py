"""Tasks on a cluster of dask.distributed, which is the extra ``cluster``."""

from __future__ import annotations

import asyncio
import logging
from contextlib import ExitStack, contextmanager
from math import inf
from time import monotonic, time
from typing import TYPE_CHECKING, Any, TypeVar

from voxrt.errors import ToolError
from voxrt.plans.workers import Workers, attempt, checked

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from distributed import Client, Future, as_completed

T = TypeVar("T")

_WAIT = 60.0
"""Seconds within which a scheduler and its first worker must answer."""

_SILENCE = 30.0
"""Seconds without a finished task after which silent workers are told: those without a sign for half as long."""

_POLL = 0.1
"""Seconds between two looks after finished tasks."""

_LOOK = 0.5
"""Seconds between two questions after the number of workers."""


class DaskWorkers(Workers):
    """The workers of a cluster. `remedy` is what errors say to do where it is lost."""

    def __init__(self, client: Client, remedy: str) -> None:
        super().__init__()
        self._client, self._remedy, self._counted = client, remedy, -inf

    @property
    def count(self) -> int:
        """How many they are, counted anew after half a second."""
        if monotonic() - self._counted > _LOOK:
            self._count, self._counted = len(self._client.scheduler_info(n_workers=-1)["workers"]), monotonic()
        return self._count

    @property
    def silent(self) -> int:
        """How many have not been heard of for a quarter of a minute, as those that are stopped or cut off."""
        known = self._client.scheduler_info(n_workers=-1)["workers"].values()
        return sum(time() - one["last_seen"] > _SILENCE / 2 for one in known)

    def completed(
        self,
        task: Callable[..., T],
        calls: Sequence[tuple[object, ...]],
        shared: tuple[object, ...] = (),
        waiting: Callable[[], None] | None = None,
    ) -> Iterator[tuple[int, T]]:
        """Do tasks, those of lost workers again."""
        from distributed import as_completed  # noqa: PLC0415 - the extra `cluster`

        client = self._client
        try:
            sent = [client.scatter(one, broadcast=True) for one in shared]  # type: ignore[no-untyped-call]
            futures = [client.submit(attempt, task, *sent, *call, pure=False) for call in calls]
            numbers = {future.key: number for number, future in enumerate(futures)}
            finished = as_completed(futures, with_results=True, loop=client.loop)  # type: ignore[no-untyped-call]
            del futures  # a worker forgets the result of a future that is gone
            for future, result in _watched(finished, waiting):
                yield numbers[future.key], checked(result)
        except ToolError:
            raise
        except Exception as error:
            raise ToolError(f"the cluster is lost ({_line(error)}); {self._remedy}") from error


def _watched(finished: as_completed, waiting: Callable[[], None] | None) -> Iterator[tuple[Future[Any], Any]]:
    """Yield finished tasks with their results; call `waiting` again and again where none comes.

    A result may be at a worker that has been stopped meanwhile: it is fetched in the background.
    """
    heard = monotonic()
    while not finished.is_empty():  # type: ignore[no-untyped-call]
        if finished.has_ready():  # type: ignore[no-untyped-call]
            future, result = next(finished)
            if isinstance(result, BaseException):  # what was cancelled has its error as its result
                raise result
            yield future, result
            heard = monotonic()
            continue
        with finished.thread_condition:
            finished.thread_condition.wait(_POLL)
        if waiting is not None and monotonic() - heard > _SILENCE:
            waiting()
            heard = monotonic()


@contextmanager
def connected(scheduler: str, remedy: str) -> Iterator[DaskWorkers]:
    """Connect to a scheduler; ToolError if dask.distributed is missing, or no scheduler with a worker answers."""
    try:
        from distributed import Client  # noqa: PLC0415 - the extra `cluster`
        from distributed.comm.core import CommClosedError  # noqa: PLC0415
    except ImportError as error:
        raise ToolError(f"building on a cluster needs dask.distributed ({error}): pip install distributed") from None
    for name in ("distributed", "tornado", "asyncio", *logging.root.manager.loggerDict):
        if name.partition(".")[0] in {"distributed", "tornado", "asyncio"}:  # Dask gives some a level of their own
            logging.getLogger(name).setLevel(logging.CRITICAL)  # what goes wrong is said in one line, here
    with ExitStack() as stack:
        try:
            asyncio.run(asyncio.wait_for(_greet(scheduler), _WAIT))
            client = stack.enter_context(Client(scheduler, timeout=_WAIT, set_as_default=False))  # type: ignore[no-untyped-call]
            client.wait_for_workers(1, timeout=_WAIT)
        except TypeError as error:
            if "ssl_context" not in str(error):
                raise
            raise ToolError(
                f"{scheduler}: Dask has no certificates for TLS; "
                "name them in Dask's configuration, distributed.comm.tls"
            ) from None
        except (OSError, TimeoutError, ValueError, MemoryError, EOFError, CommClosedError) as error:
            raise ToolError(
                f"{scheduler}: no scheduler with a worker answers ({_reason(error)}); start them by "
                "'dask scheduler' and 'dask worker ADDRESS'"
            ) from None
        yield DaskWorkers(client, remedy)


async def _greet(scheduler: str) -> None:
    """Wait for the scheduler's greeting. Dask's own client waits without end for one that accepts and says nothing."""
    from distributed import Security  # noqa: PLC0415 - the extra `cluster`
    from distributed.comm.core import connect  # noqa: PLC0415

    settings = Security().get_connection_args("client")  # type: ignore[no-untyped-call]
    greeted = await connect(scheduler, timeout=_WAIT, **settings)  # type: ignore[no-untyped-call]
    greeted.abort()


def _reason(error: BaseException) -> str:
    if isinstance(error, TimeoutError):
        return f"nothing came within {_WAIT:g} s"
    return "something else is there" if isinstance(error, MemoryError) else _line(error)


def _line(error: BaseException) -> str:
    return " ".join(f"{type(error).__name__}: {error}".split())[:200]
