"""Experiments on synthetic surfaces and joints, whose right answer is known."""
