"""The manual: ``sphinx-build -W docs build/manual``."""

from importlib.metadata import version as _version

project = "voxrt"
author = "the voxrt authors"
release = _version("voxrt")
extensions = ["sphinx.ext.autodoc", "sphinx.ext.intersphinx", "numpydoc", "myst_parser"]
source_suffix = [".rst", ".md"]
html_theme = "furo"
html_title = f"voxrt {release}"
autodoc_typehints = "none"
numpydoc_show_class_members = False
myst_enable_extensions = ["colon_fence"]
