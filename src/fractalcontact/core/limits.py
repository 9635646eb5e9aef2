"""Fixed limits of verdicts, which rules apply and figures and pages quote."""

from roughcontact.limits import RESOLVED_NODES as RESOLVED_NODES

#: Fewest nodes whose area is corrected for their edges: compared with finer grids, the corrected
#: area was a third too large at 14 nodes, from 30 on within some per cent.
CORRECTED_NODES = 30

#: Fewest free nodes, between first touch and the hardness, that carry the change of the force of a
#: yielding contact with a stiffness.
MIN_FREE_NODES = 30

#: Relative differences up to which quantities are nearly equal, flat or linear, and so in part.
NEARLY, LOOSELY = 0.1, 0.25

#: Fewest cells along each side of a matrix or grid that can hold roughness.
SMALLEST_SIDE = 8

#: Sampling step of the profiles that JRC is taken from.
JRC_SAMPLING = "1.27 mm"

#: JRC of Barton's standard profiles, on which his law was measured.
JRC_RANGE = (0.0, 20.0)

#: Largest total friction angle of Barton's law, degrees (Barton & Choubey, Rock Mech. 10 (1977) 1):
#: at low stress the logarithm would take it past the vertical.
LARGEST_FRICTION_ANGLE = 70.0

#: Strength of a joint over that computed with the stated phi_b, ends of an interval: phi_b measured
#: on flat faces, the scatter of one laboratory; assumed, 5 to 95 % of 288 published shear tests
#: beside Barton's law (median 1.23), for that law alone.
FRICTION_FACTORS = {"measured": (0.87, 1.13), "assumed": (0.9, 1.9)}

#: Largest error of a stiffness that is stated, as a fraction of it.
LARGEST_STIFFNESS_ERROR = 0.5

#: Half-width of an assumed phi_b, degrees, in rules that no such tests were compared with: basic
#: friction angles are 20 to 27 degrees in schist and shale, 27 to 34 in sandstone and gneiss, 34 to
#: 40 in granite and limestone (TRB 1990, table 9.15 of Look's handbook of geotechnical tables).
ASSUMED_ANGLE_ERROR = 10.0

#: Largest fraction of the sub-windows of a size with a truncated angle; beyond it their mean
#: strength is a bound and no result.
MOSTLY_TRUNCATED = 0.5

#: Largest fraction of the window in contact with separate contacts, on whose asperities faces ride.
MAX_TOUCHING = 0.5

#: Largest relative difference of the raw contact area from F/H where contacts all crush: it is 0.01
#: to 0.02 where 97 % of the nodes bear the hardness.
ALL_CRUSH = 0.03

#: Fewest nodes of a contact domain that is compared with null models, and whose dimension has an
#: interval: below, one node more or less would change its pattern.
MIN_NODES = CORRECTED_NODES

#: Largest Delta_sigma by boxes near 0, and smallest near 2. If that of random nodes is near 2, a
#: domain has no room for a dimension of its own: near full contact both tend to 2.
NEAR_POINTS, NEAR_FULL = 0.25, 1.75

#: Fraction of the load on suspicious cells above which errors of the scans decide a number.
DECISIVE = 0.5

#: Light load, on which the theories' straight lines are compared: largest p / (E* h'_rms).
LIGHT_LOAD = 0.02

#: Largest distance of cluster sizes from their law, times the root of the number fitted: sizes
#: drawn from an exact law (beta 0.4 to 2, 60 clusters or more) lie within it in 95 of 100 draws.
LARGEST_DISTANCE = 0.85

#: Tilt of a scan, degrees, at which subtracting the mean plane (a shear) departs by 0.4 % from a
#: rotation.
STEEP_TILT = 5.0

#: Largest change of a level dilatancy over the second half of the offsets, over the mean there.
LEVEL_CHANGE = 0.1

#: Largest rms misfit of a curve that follows a law, as a fraction of its largest closure.
GOOD_FIT = 0.02

#: Largest rms misfit of a law of a seated closure curve whose constants are stated, as a fraction
#: of the largest closure: laboratories state constants of curves that bend as much.
LARGEST_MISFIT = 0.05

#: Largest over smallest pressure of a law of closure that starts from a seat.
SEATED_SPAN = 100.0

#: Nominal pressures at which stiffnesses are stated, MPa.
REFERENCE_PRESSURES = (1.0, 5.0, 10.0)

#: Probability covered by every interval the package states.
CONFIDENCE = 0.95

#: Exponents of conductance against pressure by theories and experiments: Persson's and
#: Greenwood and Williamson's are 1, Cooper, Mikic and Yovanovich (Int. J. Heat Mass Transf. 12
#: (1969) 279) and most tests 0.95. Windows that hold few hills show lower ones (Pastewka et al.,
#: Phys. Rev. E 87 (2013) 062809).
CONDUCTANCE_EXPONENTS = (0.95, 1.0)

#: Largest relative difference between two pressures that are equal but for rounding.
PRESSURE_ROUNDING = 1e-9
#: Largest ratio of the hardness of rough contacts to the joint wall strength (Tabor's 3).
HARDEST = 3.0

#: Lengths of the shear tests that Barton's law of scale was made for, mm (Bandis, Lumsden & Barton,
#: Int. J. Rock Mech. Min. Sci. 18 (1981) 1), as later work quotes them.
BANDIS_LENGTHS = (50.0, 400.0)

#: Largest intermittency of a synthetic surface; a granite face has some 0.15. From 0.5 on single
#: nodes decide the kurtosis of slopes over every distance.
MOST_INTERMITTENT = 0.4
