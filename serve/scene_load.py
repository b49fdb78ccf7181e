"""A scene that is being made and loaded, which may be cancelled meanwhile."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from voxrt.board.errors import Refused

if TYPE_CHECKING:
    from collections.abc import Coroutine
    from typing import Any

    from voxrt.board.scene import Scene


class SceneLoad:
    """The change of the scene that is in progress.

    Parameters
    ----------
    client
        The number of the client that asked for it.
    """

    def __init__(self, client: int) -> None:
        self.client = client
        self._reason: str | None = None
        self._making: asyncio.Task[Scene] | None = None

    def cancel(self, reason: str) -> None:
        """Cancel it; `reason` is what the client is told. The present scene stays."""
        self._reason = self._reason or reason
        if self._making is not None:
            self._making.cancel()

    def check(self) -> None:
        """Raise Refused where it has been cancelled."""
        if self._reason is not None:
            raise Refused(self._reason)

    async def make(self, scene: Coroutine[Any, Any, Scene]) -> Scene:
        """Wait for the scene that `scene` makes.

        Raises
        ------
        Refused
            As `scene` does, or it was cancelled.
        """
        self._making = asyncio.ensure_future(scene)
        try:
            return await self._making
        except asyncio.CancelledError:
            if self._reason is None:  # the server ends
                self._making.cancel()
                raise
            raise Refused(self._reason) from None
        finally:
            await asyncio.gather(self._making, return_exceptions=True)
            self._making = None
