"""``voxrt completion``."""

from __future__ import annotations

from typing import Literal

from voxrt.cli import app
from voxrt.cli.messages import print_answer


def completion(shell: Literal["bash", "zsh", "fish"], /) -> None:
    """Print a script that completes voxrt's command lines.

    Parameters
    ----------
    shell
        Whose script.
    """
    print_answer(app.app.generate_completion(prog_name="voxrt", shell=shell))
