"""Settings of Sphinx: `python -m sphinx -W -b html docs docs/_build/html`."""

from importlib.metadata import version as version_of

project = "plantc"
author = "the authors of plantc"
copyright = "the authors of plantc"
version = release = version_of("plantc")

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
exclude_patterns = ["_build"]
myst_heading_anchors = 3

autodoc_member_order = "bysource"
autodoc_typehints = "none"
napoleon_google_docstring = False
napoleon_use_ivar = True
napoleon_use_rtype = False

suppress_warnings = ["ref.python"]  # attributes called `inputs` and `states` on several classes

html_theme = "alabaster"
html_theme_options = {"description": "the compiler for plants", "page_width": "1100px", "fixed_sidebar": True}
html_show_copyright = False
