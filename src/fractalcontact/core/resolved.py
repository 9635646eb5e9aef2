"""How many nodes in contact a number of the contact domain needs before it means anything."""

#: Contact of fewer nodes is not resolved, and not fitted: one node more or less is 10 % of it.
RESOLVED_NODES = 10

#: The area of fewer nodes is not corrected for their edges: at 14 nodes the corrected one was a
#: third too large beside finer grids, from 30 on within some per cent.
CORRECTED_NODES = 30
