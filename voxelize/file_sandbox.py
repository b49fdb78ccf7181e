"""A process that reads strangers' files gives up its right to open any other file (Linux, by Landlock)."""

from __future__ import annotations

import contextlib
import ctypes
import os
import struct
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import voxrt

if TYPE_CHECKING:
    from collections.abc import Iterable

# linux/landlock.h; these system calls have the same numbers on all architectures.
_CREATE_RULESET, _ADD_RULE, _RESTRICT_SELF = 444, 445, 446
_ASK_VERSION = 1
_RULE_PATH_BENEATH = 1
_EXECUTE, _WRITE_FILE, _READ_FILE, _READ_DIR, _TRUNCATE = 1, 2, 4, 8, 1 << 14
_ALL_OF_VERSION_1 = (1 << 13) - 1
_OF_FILES = _EXECUTE | _WRITE_FILE | _READ_FILE | _TRUNCATE
_ALL_TCP = 3  # bind and connect
_VERSION_WITH_TRUNCATE, _VERSION_WITH_TCP = 3, 4

_PR_SET_NO_NEW_PRIVS = 38

# What an interpreter and its libraries read: programs, the table of shared libraries, facts about the machine.
_SYSTEM = (
    "/usr",
    "/lib",
    "/lib64",
    "/bin",
    "/etc/ld.so.cache",
    "/etc/localtime",
    "/etc/mime.types",
    "/proc/self",
    "/proc/meminfo",
    "/proc/cpuinfo",
    "/proc/stat",
    "/sys/devices/system",
    "/sys/fs/cgroup",
    "/dev/urandom",
    "/dev/zero",
)


def confine(readable: Iterable[Path], writable: Iterable[Path] = ()) -> bool:
    """Give up the right to open files for good, but for those below some paths and those that Python needs.

    The limits hold for this thread and for what it starts, threads and processes. They do not hold for other threads,
    so call this before there are any. TCP is given up as well, where the kernel can do that (Linux 6.7).

    Parameters
    ----------
    readable
        Files, and folders with all that is below them.
    writable
        Folders in which files may be made, changed and removed, too.

    Returns
    -------
    bool
        Whether the limits hold: False where the kernel has no Landlock (Linux before 5.13, other systems).
    """
    if sys.platform != "linux":
        return False
    kernel = ctypes.CDLL(None, use_errno=True)
    version = kernel.syscall(_CREATE_RULESET, None, ctypes.c_size_t(0), ctypes.c_uint32(_ASK_VERSION))
    if version < 1:
        return False
    handled = _ALL_OF_VERSION_1 | (_TRUNCATE if version >= _VERSION_WITH_TRUNCATE else 0)
    rights = struct.pack("=QQ", handled, _ALL_TCP) if version >= _VERSION_WITH_TCP else struct.pack("=Q", handled)
    rules = kernel.syscall(_CREATE_RULESET, rights, ctypes.c_size_t(len(rights)), ctypes.c_uint32(0))
    if rules < 0:
        return False
    read = _EXECUTE | _READ_FILE | _READ_DIR
    try:
        for path in (*readable, *_of_python()):
            _allow(kernel, rules, path, read)
        _allow(kernel, rules, Path(os.devnull), read | _WRITE_FILE | (handled & _TRUNCATE))
        for path in writable:
            _allow(kernel, rules, path, handled)
        if kernel.prctl(_PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0:
            return False
        return bool(kernel.syscall(_RESTRICT_SELF, rules, ctypes.c_uint32(0)) == 0)
    finally:
        os.close(rules)


def _of_python() -> list[Path]:
    folders = [sys.prefix, sys.base_prefix, sys.exec_prefix, *(one for one in sys.path if one)]
    libraries = [one for one in os.environ.get("LD_LIBRARY_PATH", "").split(":") if one]
    package = str(Path(voxrt.__file__).resolve().parent.parent)  # an editable installation is not on sys.path
    return [Path(one) for one in (*_SYSTEM, *folders, *libraries, package)]


def _allow(kernel: ctypes.CDLL, rules: int, path: Path, rights: int) -> None:
    """Allow `rights` below a path; a path that is not there needs no rule."""
    with contextlib.suppress(OSError):
        opened = os.open(path, os.O_PATH | os.O_CLOEXEC)
        try:
            of_kind = rights if path.is_dir() else rights & _OF_FILES
            rule = struct.pack("=Qi", of_kind, opened)
            kernel.syscall(_ADD_RULE, rules, ctypes.c_int(_RULE_PATH_BENEATH), rule, ctypes.c_uint32(0))
        finally:
            os.close(opened)
