"""How `make docs` builds the documentation, with the whole repository as Sphinx's source.

Pages lie on the site where their files lie in the repository, so that links between them hold in
both places. Nothing that is built loads anything from another host (`extensions/own_only.py`).
"""  # noqa: INP001 - a script of Sphinx, in no package.

import sys
from pathlib import Path

from rigid import __version__

sys.path.insert(0, str(Path(__file__).parent))  # For `extensions`.

project = "RIGID"
author = "The RIGID developers"
copyright = "The RIGID developers, Apache-2.0"  # noqa: A001 - Sphinx's name for it.
version = release = __version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "extensions.command_pages",
    "extensions.mathml",
    "extensions.own_only",
]
root_doc = "docs/index"
include_patterns = [
    "docs/**.md",
    "examples/**.md",
    "results/**.md",
    "benchmarks/README.md",
    "README.md",
    "CHANGELOG.md",
    "CONTRIBUTING.md",
]
source_suffix = {".md": "markdown"}

myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 3  # As on GitHub, for links into pages.

default_role = "code"  # Docstrings are Markdown at heart: `name` is code.
add_module_names = False
autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
autodoc_preserve_defaults = True
napoleon_google_docstring = True
napoleon_numpy_docstring = False

html_theme = "furo"
html_title = f"RIGID {release}"
html_static_path = ["extensions/static"]
html_css_files = ["site.css"]
html_extra_path = ["extensions/root"]
html_math_renderer = "mathml"
html_copy_source = False
html_show_sphinx = False
