"""Two hundred words that a header may hold and that say nothing of how its numbers are read."""

import numpy as np

_WORDS = """
joint spacing; load step; sampling length; angular increment; calibration interval; step height
cut-off; bed separation; bolt spacing; layer pitch; thread pitch; fringe spacing; lattice spacing
evaluation length; line interval; tip radius; stylus diameter; working distance; depth of field
standoff; scan length; travel; stroke; gauge length; specimen height; sample width; core diameter
block size; grain size; crystal size; pore size; fracture spacing; burden; hole depth; overbreak
shear displacement; normal displacement; dilation; creep; settlement; convergence; overlap
resolution of the camera; lateral resolution; vertical resolution; repeatability; uncertainty
noise; drift; focal length; wavelength; spot size; beam width; aperture of the lens; slit width
exposure time; integration time; frame interval; averaging; gain; threshold of the sensor; offset
temperature; humidity; pressure; air density; altitude of the site; latitude; longitude; azimuth
dip; strike; plunge; trend of striae; rake; dip direction; bearing; inclination; tilt of the stage
origin: Upper Austria; origin: Lower Saxony; origin: top of bench 3; first row of bolts: bottom
region: Top End; quarry: Upper Mill; locality: Bottom Creek; operator: M. Down; client: Depth Ltd
missing; invalid; void ratio; blank holder force; fill factor; null meridian; no data from operator
number of faces; number of scans; passes; points; counts; columns of basalt; rows of bolts; layers
porosity; density; saturation; water content; permeability; conductivity; velocity; amplitude
modulus; strength; cohesion; friction angle; hardness; toughness; Poisson's ratio; stiffness
normal load; shear load; stress; strain rate; load rate; cycle; frequency; period; duration
date; time; shift; project; contract; drawing; revision; version; serial number; firmware
software; licence; file name; folder; checksum; format; encoding; language; decimal places
unit of the report: inch; unit weight; unit cost; unit 7; scale of the map; scale 1:50; zoom factor
scale bar; height of the operator; height above sea; elevation of the shaft; depth of the borehole
depth, positive downwards, of the water table; down time; up time; upward leg; downhole length
colour; lustre; texture; lithology; formation; age; weathering grade; roughness class; JRC class
Ra; Rq; Rz; Sa; Sq; Sz; Ssk; Sku; Sdr; Spk; Svk; Hurst exponent; fractal dimension; correlation
filter; lambda c; lambda s; Gaussian; spline; form removal; levelling; outlier removal; smoothing
x axis: to the north; y axis: upward; z axis: out of the face; mirror; rotation; transposed: no
delimiter: semicolon; decimal: comma; header: 12; axes: both; kind: aperture; layout: points
"""
WORDS = [word.strip() for line in _WORDS.strip().splitlines() for word in line.split(";")]
_VALUES = ["20 mm", "5", "0.8 mm", "2 deg", "12 months", "0", "0.25 um", "-9999", "3 kN", "50x",
           "0.1 x 0.1 mm", "1 of 4", "top", "12.5 um/px", "1e-3 m", "(mm)", "down"]  # fmt: skip


def foreign_lines(rng: np.random.Generator, count: int) -> list[str]:
    """Lines of a header that mean something else than how the file is read."""
    words = rng.choice(WORDS, count, replace=False)
    return [f"{word}{rng.choice([': ', ' = ', ' '])}{rng.choice(_VALUES)}" for word in words]
