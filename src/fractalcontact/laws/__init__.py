"""Laws of one joint over load: closure, contact area, strength, conductance, and their fits."""
