"""Sphinx over the docstrings of the package and the chapters of the guide; `cargo xtask python --docs` runs it."""

import roughcontact

project = "roughcontact"
author = "the authors of rc"
release = version = roughcontact.__version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
root_doc = "index"
exclude_patterns = ["extra", "guide/SUMMARY.md", "guide/architecture.md"]
html_extra_path = ["extra"]
html_theme = "alabaster"
html_theme_options = {"description": "Contact of rough elastic surfaces", "page_width": "1100px", "sidebar_width": "260px"}

autodoc_member_order = "bysource"
autodoc_typehints = "description"
autodoc_typehints_description_target = "documented"
napoleon_google_docstring = False
napoleon_use_rtype = False
myst_heading_anchors = 3
myst_enable_extensions = ["dollarmath"]
# Blocks of the guide that are marked for its tests are code of a shell all the same; anchors are those of mdBook.
suppress_warnings = ["misc.highlighting_failure", "myst.xref_missing", "myst.header"]
