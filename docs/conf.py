"""Settings of the documentation, which `make docs` builds with every warning as an error."""

import fractalcontact

project = "fractalcontact"
author = "The fractalcontact founders"
version = release = fractalcontact.__version__

extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.mathjax"]
source_suffix = {".md": "myst-nb", ".ipynb": "myst-nb"}
exclude_patterns = ["_build"]
# So that links to a heading are checked as those to a page are.
myst_heading_anchors = 3
myst_enable_extensions = ["dollarmath"]
# Notebooks are stored without results, and run at every build.
nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_timeout = 300  # seconds: the first solve compiles kernels
autodoc_member_order = "bysource"
autodoc_typehints = "none"  # the docstrings state types, with shapes and units
napoleon_use_rtype = False

html_theme = "alabaster"  # comes with Sphinx
html_title = f"fractalcontact {version}"
html_theme_options = {
    "description": "Rough contact of cracks in rock and concrete",
    "page_width": "76rem",
    "sidebar_width": "16rem",
    "font_family": "system-ui, sans-serif",
    "head_font_family": "system-ui, sans-serif",
    "fixed_sidebar": True,
}
html_show_copyright = False
html_copy_source = False
