"""The choice of workers by the options of a command."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

from voxrt.plans.workers import Workers

if TYPE_CHECKING:
    from collections.abc import Iterator


@contextmanager
def open_workers(scheduler: str | None, workers: int | None, *, remedy: str) -> Iterator[Workers]:
    """Connect to a cluster where a scheduler is named, or take so many processes, or this one where none are asked for.

    `remedy` is what errors say to do where the cluster is lost. ToolError if there is none.
    """
    if scheduler is not None:
        from voxrt.plans.dask_workers import connected  # noqa: PLC0415 - the extra `cluster`

        with connected(scheduler, remedy) as cluster:
            yield cluster
    elif workers is not None:
        from voxrt.plans.local_workers import LocalWorkers  # noqa: PLC0415 - slow to import, and few builds need it

        yield LocalWorkers(workers)
    else:
        yield Workers()
