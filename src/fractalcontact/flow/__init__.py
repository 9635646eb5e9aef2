"""Aperture of a joint and the flow through it, by the local cubic law."""
