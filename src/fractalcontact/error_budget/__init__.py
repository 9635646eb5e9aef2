"""Errors of the published quantities, split by their source."""
