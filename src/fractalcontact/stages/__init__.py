"""Stages: what the jobs of a study compute, each from the stages before it."""
