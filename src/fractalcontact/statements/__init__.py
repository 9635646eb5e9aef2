"""Statements of the paper, compared with the atlas of a study."""
