"""Units and kinds of the synthetic surfaces of the experiments.

The elastic problem is linear in heights and depends on F/E* alone and on no length, so that areas,
slopes and dimensions do not depend on these values.
"""

#: Side of a cell, mm.
SPACING = 1.0
#: Contact modulus E*, MPa.
E_STAR = 1.0
#: Root mean square height as a fraction of the side, where the surface is loaded.
RMS_FRACTION = 0.01

#: Kinds of surface: with a roll-off many hills share the load, without it a few carry all.
SURFACES = ("with_roll_off", "without_roll_off")
