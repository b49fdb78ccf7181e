"""Live: every change of a scene is sent to its address, when nothing has moved for a while."""

from __future__ import annotations

import time
from typing import Any

import bpy

from .commands import WATCH
from .sender import SENDERS
from .viewport import REST_SECONDS

_BUSY_SECONDS = 0.1  # between looks whether the scene before is shown


class _Live:
    """Waits for the end of changes, then sends the scene by the operator."""

    def __init__(self) -> None:
        self._changed = 0.0
        self.sending = False

    def note(self, scene: Any, depsgraph: Any) -> None:
        """Take note of a change: a handler of updates of the dependency graph."""
        if self.sending or not scene.voxrt.live or not len(depsgraph.updates):
            return
        self._changed = time.monotonic()
        if not bpy.app.timers.is_registered(send_at_rest):
            bpy.app.timers.register(send_at_rest, first_interval=REST_SECONDS)

    def send_at_rest(self) -> float | None:
        """Send the scene if nothing has changed for a while; return the seconds to wait else: a timer."""
        left = self._changed + REST_SECONDS - time.monotonic()
        if left > 0:
            return left
        if SENDERS.busy:
            return _BUSY_SECONDS
        self.sending = True
        try:
            bpy.ops.voxrt.send(changed_only=True)
        except RuntimeError as error:
            WATCH.line = str(error).strip()
        finally:
            self.sending = False
        return None


LIVE = _Live()


def send_at_rest() -> float | None:
    """Send what has changed: a timer, which Blender knows by its address."""
    return LIVE.send_at_rest()


@bpy.app.handlers.persistent  # type: ignore[untyped-decorator]
def _updated(scene: Any, depsgraph: Any) -> None:
    LIVE.note(scene, depsgraph)


@bpy.app.handlers.persistent  # type: ignore[untyped-decorator]
def _leaving(_: Any) -> None:
    SENDERS.close()


def register() -> None:
    """Begin to listen to changes."""
    bpy.app.handlers.depsgraph_update_post.append(_updated)
    bpy.app.handlers.load_pre.append(_leaving)


def unregister() -> None:
    """Undo :func:`register`."""
    SENDERS.finish()
    bpy.app.handlers.load_pre.remove(_leaving)
    bpy.app.handlers.depsgraph_update_post.remove(_updated)
    if bpy.app.timers.is_registered(send_at_rest):
        bpy.app.timers.unregister(send_at_rest)
