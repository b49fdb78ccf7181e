"""``voxrt completion``."""

from __future__ import annotations

import sys
from typing import Literal

from voxrt.cli import app


def completion(shell: Literal["bash", "zsh", "fish"], /) -> None:
    """Print a script that completes voxrt's command lines.

    Parameters
    ----------
    shell
        Whose script.
    """
    sys.stdout.write(app.app.generate_completion(prog_name="voxrt", shell=shell))
