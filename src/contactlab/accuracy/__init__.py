"""Accuracy, speed and stability of the solver, of other solvers and of cheaper models."""
