"""Settings of the documentation site: ``make docs`` builds it, with every warning an error.

Nothing is fetched while it is built or read: formulas become MathML, fonts are the reader's.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import propmdao

project = "propmdao"
author = "the propmdao developers"
copyright = "the propmdao developers, Apache License 2.0"
version = release = propmdao.__version__

extensions = [
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",  # docstrings in numpydoc's form, with sections of their own
    "myst_nb",  # Markdown pages, and those with code that runs
    "site_directives",  # help of the commands, tables of records
    "mathml",
]
exclude_patterns = ["README.md"]
root_doc = "index"
html_theme = "furo"
html_title = f"propmdao {release}"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_show_sphinx = False
html_copy_source = False
pygments_style = "friendly"
default_role = "py:obj"  # `Name` in a docstring is a link where there is such a thing

myst_enable_extensions = ["dollarmath", "colon_fence", "deflist"]
myst_heading_anchors = 3
suppress_warnings = ["misc.highlighting_failure"]

# Pages with code run when the site is built, and a block that fails fails the build.
nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_in_temp = True
nb_execution_timeout = 600
nb_output_stderr = "remove"  # progress, and warnings of other packages with their paths
nb_render_markdown_format = "myst"

autodoc_member_order = "bysource"
autodoc_typehints = "none"  # docstrings say types, with shapes and units
napoleon_google_docstring = False
napoleon_use_rtype = False
napoleon_use_ivar = True
napoleon_custom_sections = [
    ("Inputs", "params_style"),
    ("Outputs", "params_style"),
    ("Options", "params_style"),
]
