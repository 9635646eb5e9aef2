"""The laboratory: other solvers, error against time, stability, synthetic surfaces.

It imports the chain and the solver; neither imports it.
"""
