"""Pages with blank pictures do not pass, and the pictures of the class chapter are the same each time."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib import pyplot as plt
from PIL import Image

REPOSITORY = Path(__file__).resolve().parents[2]


@pytest.fixture(autouse=True)
def _no_screen():
    mpl.use("Agg")
    yield
    plt.close("all")


def test_blank_pictures_are_found(tmp_path):
    import check_pictures

    blank = np.full((200, 300, 3), 255, np.uint8)
    Image.fromarray(blank).save(tmp_path / "blank.png")
    blank[:1, :50] = 0  # a line that nobody would call a picture
    Image.fromarray(blank).save(tmp_path / "nearly.png")
    blank[50:150, 50:150] = 90
    Image.fromarray(blank).save(tmp_path / "square.png")
    assert [line.split(":")[0] for line in check_pictures.blank_pictures(tmp_path)] == ["blank.png", "nearly.png"]


def test_empty_axes_are_found():
    import check_pictures

    figure, (_, right) = plt.subplots(1, 2)
    assert check_pictures.empty_axes(figure) == 2
    right.plot([0, 1], [1, 0])
    assert check_pictures.empty_axes(figure) == 1


def test_an_example_with_empty_axes_is_refused():
    import check_pictures

    plt.subplots(1, 2)
    with pytest.raises(ValueError, match=r"page\.py: figure 1 has 2 empty axes"):
        check_pictures.scraper(("code", "", 1), {"src_file": "page.py"}, {})


def test_no_picture_of_the_repository_is_blank():
    import check_pictures

    for folder in ("docs/pictures", "tests/examples/pictures"):
        assert check_pictures.blank_pictures(REPOSITORY / folder) == []


def test_the_pictures_of_the_chapter_are_the_same_each_time(tmp_path):
    pytest.importorskip("voxrt.sim._rtl", reason="there is no verilated ray tracer")
    import check_pictures
    import draw

    for run in ("first", "second"):
        draw.main(tmp_path / run)
    names = sorted(path.name for path in (tmp_path / "first").iterdir())
    assert len(names) == 13
    for name in names:
        assert (tmp_path / "first" / name).read_bytes() == (tmp_path / "second" / name).read_bytes(), name
    assert check_pictures.blank_pictures(tmp_path / "first") == []
    text = (REPOSITORY / "docs" / "how-a-ray-walks.md").read_text(encoding="utf-8")
    assert [name for name in names if f"walk/pictures/{name}" not in text] == []
