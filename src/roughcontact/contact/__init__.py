"""The contact solver: frictionless elastic contact of a rough surface with a rigid plane."""
