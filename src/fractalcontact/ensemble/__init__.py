"""Ensembles: realisations of an embedded specimen, and the spread of contact among them."""
