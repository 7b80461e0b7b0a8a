"""Settings of the documentation; `sphinx-build -W -b html docs docs/_build` needs no network."""

import sys
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parents[1]), str(Path(__file__).parent)]

import gallery  # noqa: E402 - it and the package are found by the paths above

from ehdmaps import version as ehdmaps_version  # noqa: E402

gallery.make_gallery()

project = "ehdmaps"
author = "The ehdmaps developers"
copyright = author
release = ehdmaps_version.version()

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.mathjax"]
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 3
napoleon_google_docstring = False
autodoc_typehints = "none"
autodoc_member_order = "bysource"
exclude_patterns = ["_build"]
highlight_language = "none"  # of blocks without a language: printed tables
html_theme = "furo"
html_static_path = ["wide.css"]
html_css_files = ["wide.css"]
html_title = f"ehdmaps {release.partition('+')[0]}"
