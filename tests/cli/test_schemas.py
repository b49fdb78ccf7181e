"""What ``--json`` promises is what the manual says."""

from __future__ import annotations

from pathlib import Path

import pytest

from voxrt.cli.schemas import schema

MANUAL = Path(__file__).resolve().parents[2] / "docs" / "commands.md"


@pytest.mark.parametrize(
    "name", ["BuildReport", "RenderResult", "TraceResult", "ReadingEntry", "PixelColour", "Surface"]
)
def test_the_manual_names_every_field(name):
    text = MANUAL.read_text()
    for field in schema()[name]["properties"]:
        assert f"`{field}`" in text, field


def test_the_promised_fields_are_required():
    definitions = schema()
    assert set(definitions["BuildReport"]["required"]) >= {
        "outputs", "depth", "words", "blocks", "voxels", "materials", "warnings", "seconds", "render"
    }  # fmt: skip
    assert set(definitions["RenderResult"]["required"]) >= {
        "rays", "cycles", "words_read", "cycles_per_pixel", "words_per_ray", "seconds"
    }  # fmt: skip
