"""A study: its configuration, scan files, list of figures, and the atlas."""
