"""Markup of docstrings, which no reader of a page, a caption, a table or the atlas should meet."""

import re

MARKUP = re.compile(r":(?:func|mod|class|meth|data|attr|exc|obj|ref|doc|term):|``")
