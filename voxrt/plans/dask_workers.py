"""Tasks on a cluster of dask.distributed, which is the extra ``cluster``."""

from __future__ import annotations

import logging
from contextlib import ExitStack, contextmanager
from math import inf
from time import monotonic
from typing import TYPE_CHECKING, TypeVar

from voxrt.errors import ToolError
from voxrt.plans.workers import Workers, attempt, checked

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from distributed import Client

T = TypeVar("T")

_WAIT = 60.0
"""Seconds within which a scheduler and its first worker must answer."""

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

    def completed(
        self, task: Callable[..., T], calls: Sequence[tuple[object, ...]], shared: tuple[object, ...] = ()
    ) -> Iterator[tuple[int, T]]:
        """Do tasks, those of lost workers again."""
        from distributed import as_completed  # noqa: PLC0415 - the extra `cluster`

        client = self._client
        try:
            sent = [client.scatter(one, broadcast=True) for one in shared]  # type: ignore[no-untyped-call]
            futures = [client.submit(attempt, task, *sent, *call, pure=False) for call in calls]
            numbers = {future.key: number for number, future in enumerate(futures)}
            finished = as_completed(futures, loop=client.loop)  # type: ignore[no-untyped-call]
            del futures  # a worker forgets the result of a future that is gone
            for future in finished:
                yield numbers[future.key], checked(future.result())
        except ToolError:
            raise
        except Exception as error:
            raise ToolError(f"the cluster is lost ({_line(error)}); {self._remedy}") from error


@contextmanager
def connected(scheduler: str, remedy: str) -> Iterator[DaskWorkers]:
    """Connect to a scheduler; ToolError if dask.distributed is missing, or no scheduler with a worker answers."""
    try:
        from distributed import Client  # noqa: PLC0415 - the extra `cluster`
    except ImportError as error:
        raise ToolError(
            f"building on a cluster needs dask.distributed ({error}): pip install 'voxrt-build[cluster]'"
        ) from None
    for name in ("distributed", "tornado", "asyncio"):
        logging.getLogger(name).setLevel(logging.CRITICAL)  # what goes wrong is said in one line, here
    with ExitStack() as stack:
        try:
            client = stack.enter_context(Client(scheduler, timeout=_WAIT, set_as_default=False))  # type: ignore[no-untyped-call]
            client.wait_for_workers(1, timeout=_WAIT)
        except (OSError, TimeoutError, ValueError) as error:
            raise ToolError(
                f"{scheduler}: no scheduler with a worker answers ({_line(error)}); start them by "
                "'dask scheduler' and 'dask worker ADDRESS'"
            ) from None
        yield DaskWorkers(client, remedy)


def _line(error: BaseException) -> str:
    return " ".join(f"{type(error).__name__}: {error}".split())[:200]
