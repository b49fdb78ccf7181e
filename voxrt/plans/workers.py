"""Those who do the tasks of a plan or of a camera path. These here are this process alone; others are subclasses."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

from msgspec import Struct

from voxrt.errors import ToolError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

T = TypeVar("T")


class Workers:
    """The present process, which does one task after another. `count`: how many workers there are."""

    def __init__(self, count: int = 1) -> None:
        self._count = count

    @property
    def count(self) -> int:
        """How many workers there are now."""
        return self._count

    @property
    def silent(self) -> int:
        """How many of them have not been heard of for so long that a user should look after them."""
        return 0

    def completed(
        self,
        task: Callable[..., T],
        calls: Sequence[tuple[object, ...]],
        shared: tuple[object, ...] = (),
        waiting: Callable[[], None] | None = None,  # noqa: ARG002 - the present process never waits
    ) -> Iterator[tuple[int, T]]:
        """Call task(*shared, *call) for each call, and yield its number and the result as tasks are done.

        `waiting` is called now and then while no task is done on a cluster.
        The task is a function of a module; each process gets its `shared` arguments once. ToolError if a task fails in
        a worker, or workers are lost.
        """
        yield from enumerate(task(*shared, *call) for call in calls)


class Failure(Struct, frozen=True):
    """What went wrong in a worker, as text: not every exception can travel."""

    message: str


def attempt(task: Callable[..., T], *arguments: object) -> T | Failure:
    """Do a task in a worker."""
    try:
        return task(*arguments)
    except ToolError as error:
        return Failure(str(error))
    except MemoryError:
        return Failure("a worker is out of memory; give it more, or a smaller --memory")
    except Exception as error:  # noqa: BLE001 - any error of a worker is one of the build
        return Failure(f"a worker failed: {str(error) or type(error).__name__}")


def checked(result: T | Failure) -> T:
    """Return the result of a worker; ToolError if it failed."""
    if isinstance(result, Failure):
        raise ToolError(result.message)
    return result


def in_order(completed: Iterator[tuple[int, T]]) -> Iterator[T]:
    """Yield results in the order of their calls.

    Examples
    --------
    >>> list(in_order(iter([(1, "b"), (0, "a"), (2, "c")])))
    ['a', 'b', 'c']
    """
    early: dict[int, T] = {}
    following = 0
    for number, result in completed:
        early[number] = result
        while following in early:
            yield early.pop(following)
            following += 1
