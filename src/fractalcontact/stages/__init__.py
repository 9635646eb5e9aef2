"""Stages: the computations of the jobs of a study, each from earlier stages."""
