"""Fixed limits of verdicts, which rules apply and figures and pages quote."""

from roughcontact.limits import RESOLVED_NODES as RESOLVED_NODES

#: The area of fewer nodes is not corrected for their edges: at 14 nodes the corrected one was a
#: third too large beside finer grids, from 30 on within some per cent.
CORRECTED_NODES = 30

#: What is called nearly equal, nearly flat or nearly linear, and what is so in part.
NEARLY, LOOSELY = 0.1, 0.25

#: A matrix or grid needs at least this many cells along each side to hold any roughness.
SMALLEST_SIDE = 8

#: Sampling step of the profiles that JRC is taken from.
JRC_SAMPLING = "1.27 mm"

#: JRC of Barton's standard profiles, on which his law was measured.
JRC_RANGE = (0.0, 20.0)

#: Barton's total friction angle is not used above this, degrees (Barton & Choubey, Rock Mech. 10
#: (1977) 1): at low stress the logarithm would take it past the vertical.
LARGEST_FRICTION_ANGLE = 70.0

#: Where more than this fraction of the sub-windows of a size had their angle truncated there, their
#: mean strength is a bound and no result.
MOSTLY_TRUNCATED = 0.5

#: Contacts are separate, and the faces ride on asperities, where no larger fraction of the window
#: touches.
MAX_TOUCHING = 0.5

#: A contact domain of fewer nodes is compared with no null model, and its dimension has no
#: interval: one node more or less would change its pattern.
MIN_NODES = CORRECTED_NODES

#: Delta_sigma by boxes up to here is near 0, and from here on near 2. Random nodes beyond it leave
#: a domain no room for a dimension of its own: near full contact both tend to 2.
NEAR_POINTS, NEAR_FULL = 0.25, 1.75

#: Above this fraction of the load on suspicious cells, errors of the scans decide a number.
DECISIVE = 0.5

#: Light load, on which the theories' straight lines are compared: largest p / (E* h'_rms).
LIGHT_LOAD = 0.02

#: Sizes drawn from an exact law (beta 0.4 to 2, 60 clusters or more) lie within this, over the root
#: of the number fitted, of the law fitted to them in at least 95 of 100 draws.
LARGEST_DISTANCE = 0.85

#: Tilt of a scan above which subtracting the mean plane (a shear) departs from turning
#: the specimen by 0.4 %.
STEEP_TILT = 5.0  # degrees

#: Change over the second half of the offsets, a fraction of the mean there, that is called level.
LEVEL_CHANGE = 0.1

#: Rms misfit up to which a curve is said to follow a law, as a fraction of its largest closure.
GOOD_FIT = 0.02

#: Rms misfit up to which the constants of a law that is fitted to a seated closure curve are
#: stated, as a fraction of the largest closure: laboratories state them of curves that bend so.
LARGEST_MISFIT = 0.05

#: Largest over smallest pressure of a law of closure that is counted from a seat.
SEATED_SPAN = 100.0

#: Nominal pressures at which stiffnesses are stated, MPa.
REFERENCE_PRESSURES = (1.0, 5.0, 10.0)

#: Probability covered by every interval the package states.
CONFIDENCE = 0.95

#: Exponents of conductance against pressure that theories and experiments give: Persson's and
#: Greenwood and Williamson's are 1, Cooper, Mikic and Yovanovich (Int. J. Heat Mass Transf. 12
#: (1969) 279) and most tests 0.95. Windows that hold few hills show lower ones (Pastewka et al.,
#: Phys. Rev. E 87 (2013) 062809).
CONDUCTANCE_EXPONENTS = (0.95, 1.0)
