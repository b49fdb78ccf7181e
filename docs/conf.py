"""The manual: ``sphinx-build -W docs build/manual``."""

from importlib.metadata import version as _version

project = "voxrt"
author = "the voxrt authors"
release = _version("voxrt-build")
extensions = ["sphinx.ext.autodoc", "sphinx.ext.intersphinx", "numpydoc", "myst_parser", "sphinx_gallery.gen_gallery"]
source_suffix = [".rst", ".md"]
html_theme = "furo"
html_title = f"voxrt {release}"
autodoc_typehints = "none"
numpydoc_show_class_members = False
myst_enable_extensions = ["colon_fence"]
sphinx_gallery_conf = {
    "examples_dirs": ["../examples/gallery", "../bench/study"],
    "gallery_dirs": ["gallery", "study"],
    "filename_pattern": "",  # all are run
    "abort_on_example_error": True,
    "download_all_examples": False,
    "show_signature": False,
    "show_memory": False,
}
