"""The sender of memories: one process per address, which keeps the line of a board open while scenes change."""

from __future__ import annotations

import json
import subprocess
import tempfile
import time
from contextlib import suppress
from pathlib import Path

from .commands import RunningCommand

_SECONDS = 0.05  # between looks for an answer
_LAST_SECONDS = 5.0  # for what is on its way when Blender ends
_ERROR = "voxrt: error: "


class Upload:
    """A memory on its way; :class:`~.commands.Watch` follows it."""

    def __init__(self, sender: Sender, number: int) -> None:
        self._sender = sender
        self._number = number

    @property
    def ended(self) -> bool:
        """Whether it was shown, or refused; and the line is closed, where nothing else is sent."""
        sender = self._sender
        return sender.ended or (not sender.closed and len(sender.answers()) > self._number)

    def outcome(self) -> tuple[bool, str]:
        """Wait for its end. Return whether it is shown, and a line about it."""
        while not self.ended:
            time.sleep(_SECONDS)
        answers = self._sender.answers()
        return answers[self._number] if self._number < len(answers) else (False, "the sender ended: send again")

    def stop(self) -> None:
        """Let it end by itself: a board keeps the scene before until it has all of the next."""


class Sender:
    """Sends memories to one address, one after the other, by ``voxrt upload -``.

    Attributes
    ----------
    address
        As ``voxrt upload --to`` takes it.
    closed
        No more memories are sent.
    """

    def __init__(self, address: str) -> None:
        self.address = address
        self._folder = tempfile.TemporaryDirectory(prefix="voxrt-")
        arguments = ["upload", "-", "--json", "--to", address]
        self._command = RunningCommand(arguments, self._folder, stdin=subprocess.PIPE)
        self.closed = False
        self._files: list[Path] = []
        self._last = b""

    @property
    def ended(self) -> bool:
        """Whether its process has ended."""
        return self._command.ended

    @property
    def busy(self) -> bool:
        """Whether a memory is on its way."""
        return not self.ended and len(self.answers()) < len(self._files)

    def holds(self, blob: bytes) -> bool:
        """Whether these bytes were sent last, and are shown or on their way."""
        answers = self.answers()
        refused = len(answers) == len(self._files) > 0 and not answers[-1][0]
        return blob == self._last and not refused

    def send(self, blob: bytes) -> Upload:
        """Send the bytes of a ``.blob``."""
        for file in self._files[: len(self.answers())]:
            file.unlink(missing_ok=True)
        file = Path(self._folder.name, f"scene{len(self._files)}.blob")
        file.write_bytes(blob)
        self._files.append(file)
        self._last = blob
        with suppress(BrokenPipeError):  # the process has ended: so has the upload
            self._command.write(f"{file}\n")
        return Upload(self, len(self._files) - 1)

    def answers(self) -> list[tuple[bool, str]]:
        """Return what became of each memory so far: whether it is shown, and a line about it."""
        found, text = [], ""
        for line in self._command.printed().splitlines(keepends=True):
            text += line
            if line == "}\n":
                found.append((True, f"{json.loads(text)['words']:,} words are shown"))
                text = ""
            elif not text.startswith("{"):
                if line.startswith(_ERROR) and line.endswith("\n"):
                    found.append((False, line.removeprefix(_ERROR).strip()))
                text = ""
        return found

    def close(self) -> None:
        """Close the line when what is on its way has come."""
        self.closed = True
        self._command.close_input()

    def finish(self) -> None:
        """End a process that was closed, and remove its files."""
        self._command.finish(_LAST_SECONDS)


class Senders:
    """The sender of this Blender: it alone has a line open."""

    def __init__(self) -> None:
        self._sender: Sender | None = None
        self._closing: list[Sender] = []  # their files stay until they end

    def to(self, address: str) -> Sender:
        """Return the sender to an address. One to another address is closed."""
        if self._sender is None or self._sender.address != address or self._sender.ended:
            self.close()
            self._sender = Sender(address)
        return self._sender

    @property
    def busy(self) -> bool:
        """Whether a memory is on its way."""
        return self._sender is not None and self._sender.busy

    def close(self) -> None:
        """Close the line."""
        sender, self._sender = self._sender, None
        for one in self._closing:
            if one.ended:
                one.finish()
        self._closing = [one for one in self._closing if not one.ended]
        if sender is not None:
            sender.close()
            self._closing.append(sender)

    def finish(self) -> None:
        """Close the line, and wait until it is."""
        self.close()
        for one in self._closing:
            one.finish()
        self._closing = []


SENDERS = Senders()
