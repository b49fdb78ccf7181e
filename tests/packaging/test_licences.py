"""The manual's list of licences has every package that voxrt asks for, and says what these packages say."""

from __future__ import annotations

import re
import tomllib
from importlib.metadata import PackageNotFoundError, metadata
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

SAID = {
    "BSD-3-Clause": ("BSD",),
    "BSD-2-Clause": ("BSD",),
    "Apache-2.0": ("Apache",),
    "MIT": ("MIT",),
    "MIT-CMU": ("MIT-CMU", "HPND"),
    "TOST-1.0": ("TOST", "Other/Proprietary License"),
    "ISC": ("ISC",),
    "GPL-3.0": ("GPL",),
    "Matplotlib": ("matplotlib",),
    "LGPL-3.0-only": ("Apache-2.0", "LGPL"),
}
"""How the metadata of packages calls a licence."""


def listed() -> dict[str, tuple[str, str]]:
    rows = re.findall(r"^\| ([\w-]+) \| (.+?) \| (.+?) \|$", (ROOT / "docs" / "licences.md").read_text(), re.MULTILINE)
    return {name: (licence, where) for name, licence, where in rows if name != "package"}


def requirements() -> dict[str, str]:
    """Every package that pyproject.toml asks users to install, and when."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    needs = dict.fromkeys(project["project"]["dependencies"], "always")
    for extra, packages in project["project"]["optional-dependencies"].items():
        needs |= dict.fromkeys(packages, f"extra `{extra}`")
    needs |= dict.fromkeys(project["build-system"]["requires"], "to build voxrt")
    return {re.split(r"[^\w-]", need)[0].lower(): when for need, when in needs.items()}


def test_the_list_is_complete():
    assert {name: where for name, (_, where) in listed().items()} == requirements()


@pytest.mark.parametrize("name", listed())
def test_the_package_says_the_same(name):
    try:
        fields = metadata(name)
    except PackageNotFoundError:
        pytest.skip(f"{name} is not installed")
    classifiers = [line for line in fields.get_all("Classifier") or [] if line.startswith("License")]
    text = " ".join([fields.get("License-Expression") or "", fields.get("License") or "", *classifiers])
    licence = listed()[name][0]
    (key,) = (key for key in SAID if re.match(rf"{re.escape(key)}(?![\w-])", licence))
    assert any(word in text for word in SAID[key]), text


def test_every_need_of_users_has_a_lower_bound():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    needs = [*project["dependencies"], *(need for extra in project["optional-dependencies"].values() for need in extra)]
    assert [need for need in needs if ">=" not in need] == []
