"""Supplementary figures of a specimen or joint."""
