"""The manual: ``sphinx-build -W docs build/docs``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from sphinx import addnodes
from sphinx.errors import SphinxError

import voxrt

if TYPE_CHECKING:
    from docutils import nodes
    from sphinx.application import Sphinx

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parent
sys.path[:0] = [str(HERE), str(HERE / "walk")]
import check_pictures  # noqa: E402 - they stand beside this file
import draw  # noqa: E402
import make_measured  # noqa: E402
import make_options  # noqa: E402
import make_reference  # noqa: E402

project = "voxrt"
author = "the voxrt authors"
release = voxrt.__version__
extensions = ["sphinx.ext.autodoc", "sphinx.ext.autosummary", "numpydoc", "myst_parser", "sphinx_gallery.gen_gallery"]
source_suffix = [".rst", ".md"]
exclude_patterns = ["assets.md", "walk/pictures/*.md"]  # the first is a table for tests, the others are included
highlight_language = "none"  # blocks that name no language are drawings and commands
html_theme = "furo"
html_show_copyright = False
html_title = f"voxrt {release}"
html_static_path = ["static"]
html_css_files = ["manual.css"]
autodoc_typehints = "none"
autosummary_generate = False  # the pages of docs/reference list what there is
numpydoc_show_class_members = False
myst_enable_extensions = ["colon_fence"]
myst_heading_anchors = 3
sphinx_gallery_conf = {
    "examples_dirs": ["../examples/gallery", "../bench/study"],
    "gallery_dirs": ["gallery", "study"],
    "filename_pattern": "",  # all are run
    "abort_on_example_error": True,
    "image_scrapers": ("check_pictures.scraper",),
    "matplotlib_animations": True,
    "download_all_examples": False,
    "write_computation_times": False,
    "min_reported_time": 1e9,  # seconds: how long a page took is nobody's question
    "show_signature": False,
    "show_memory": False,
}

# Pages that are written anew with every build.
draw.main(HERE / "walk" / "pictures")
make_reference.write(HERE / "reference")
make_options.write(HERE / "reference")
measured = make_measured.write(HERE / "measured")

PAGES = {"rtl/README.md": "rtl", "rtl/generated/registers.md": "registers"}
PAGES |= {f"bench/results/{name}.md": f"measured/{name}" for name in measured}
"""Files of the repository outside ``docs`` that are pages of the manual, and their names there."""

INCLUDED_FROM = {"rtl": "rtl", "contributing": ".", "changes": "."}
"""Pages that consist of such a file: the folder from which the file's own links start."""


def link_pages(app: Sphinx, doctree: nodes.document) -> None:
    """Turn links to files of the repository into links to the pages that these files are in the manual."""
    name = app.env.docname
    for node in list(
        doctree.findall(lambda node: isinstance(node, addnodes.download_reference | addnodes.pending_xref))
    ):
        if node.get("reftype") != "myst":
            continue
        target = node["reftarget"].partition("#")[0]
        folders = [(HERE / name).parent, *([REPOSITORY / INCLUDED_FROM[name]] if name in INCLUDED_FROM else [])]
        for folder in folders:
            path = (folder / target).resolve()
            file = str(path.relative_to(REPOSITORY)) if path.is_relative_to(REPOSITORY) else ""
            page = PAGES.get(file) or PAGES.get(f"{file}.md")  # MyST takes the suffix off files that could be pages
            if folder != (HERE / name).parent and path.parent == HERE and path.suffix == ".md":
                page = path.stem
            if page:
                wanted = {"refdomain": "std", "reftype": "doc", "reftarget": f"/{page}", "refexplicit": True}
                node.replace_self(addnodes.pending_xref("", *node.children, refdoc=name, **wanted))
                break


def refuse_blank_pictures(app: Sphinx, exception: Exception | None) -> None:
    """End the build when a picture of the manual shows nothing."""
    blank = check_pictures.blank_pictures(Path(app.outdir) / "_images") if exception is None else []
    if blank:
        raise SphinxError("these pictures are blank:\n" + "\n".join(blank))


def setup(app: Sphinx) -> None:
    """Connect what this manual does besides."""
    app.connect("doctree-read", link_pages, priority=100)  # before downloads are collected
    app.connect("build-finished", refuse_blank_pictures)
