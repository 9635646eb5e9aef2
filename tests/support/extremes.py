"""Synthetic specimens at the edge of what a study can be given: planes, spikes, steps, odd sizes.

Each either goes through the whole chain with all its figures, or is refused in one sentence.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from materials import ROCK
from stated import ARRAY

from fractalcontact.surface.synthesis import self_affine

N = 48  # nodes per side unless the case says otherwise; the window has half as many
S = 0.1  # mm between them
FM = 1e-12  # mm


@dataclass(frozen=True)
class Extreme:
    """One specimen: heights (y, x) in mm, its spacing in mm, and what its sidecar says."""

    lower: np.ndarray
    upper: np.ndarray | None = None
    spacing: float = S
    options: dict[str, Any] = field(default_factory=dict)
    settings: dict[str, Any] = field(default_factory=dict)
    #: Height of the file's unit in mm: numbers may be written in fm or km.
    unit: str = "mm"


def rough(rms: float = 0.05, seed: int = 1, shape=(N, N), hurst: float = 0.8, **more) -> np.ndarray:
    """A self-affine surface."""
    side = max(shape)
    side += side % 2
    made = self_affine((side, side), S, hurst, rms=rms, seed=seed, **more)
    return made[: shape[0], : shape[1]].copy()


def noise(scale: float, seed: int = 2, shape=(N, N)) -> np.ndarray:
    return scale * np.random.default_rng(seed).normal(size=shape)


def axes(shape=(N, N)) -> tuple[np.ndarray, np.ndarray]:
    """y and x of every node, mm."""
    y, x = np.indices(shape)
    return S * y, S * x


FLAT: dict[str, Any] = {"opposite": "flat"}


def plane():
    y, x = axes()
    return Extreme(0.1 * x + 0.05 * y)


def exactly_level():
    return Extreme(np.full((N, N), 1.25))


def plane_against_plane():
    y, x = axes()
    return Extreme(0.1 * x + 0.05 * y, settings=FLAT)


def plane_of_bits():
    """A plane with the last bit of its numbers as noise."""
    _, x = axes()
    z = 1.0 + 0.01 * x
    return Extreme(z + np.spacing(z) * np.random.default_rng(0).integers(-1, 2, z.shape))


def constant_of_bits():
    z = np.full((N, N), 3.0)
    return Extreme(z + 1e-9 * np.random.default_rng(0).integers(0, 2, z.shape))


def polished():
    """45 nm rms over 6 mm: in full contact at the loads of a study."""
    return Extreme(rough(45e-6))


def polished_against_plane():
    return Extreme(rough(45e-6), settings=FLAT)


def polished_pair():
    lower = rough(45e-6)
    return Extreme(lower, lower + rough(20e-6, seed=3) + 1e-3)


def polished_noise():
    return Extreme(noise(1e-6))


def femtometres():
    return Extreme(rough(FM))


def femtometres_against_plane():
    return Extreme(rough(FM), settings=FLAT)


def picometre_pair():
    lower = rough(1e-9)
    return Extreme(lower, lower + noise(1e-9))


def one_spike():
    z = np.zeros((N, N))
    z[N // 2, N // 2] = 0.1
    return Extreme(z)


def one_spike_against_plane():
    z = np.zeros((N, N))
    z[N // 2, N // 2] = 0.1
    return Extreme(z, settings=FLAT)


def spike_on_rough():
    z = rough()
    z[N // 2 + 1, N // 2 + 3] += 3.0
    return Extreme(z)


def four_spikes():
    z = np.zeros((N, N))
    z[20::24, 20::24] = [[0.1, 0.2], [0.05, 0.1]]
    return Extreme(z)


def one_pit():
    z = np.zeros((N, N))
    z[N // 2, N // 2] = -0.5
    return Extreme(z)


def steep():
    """Slopes of ten and more: needles."""
    return Extreme(noise(1.0))


def steep_against_plane():
    return Extreme(noise(1.0), settings=FLAT)


def three_digit_slopes():
    """Slopes of hundreds, in a field that is wider than the relief is high."""
    return Extreme(noise(1.0, shape=(24, 1200)), spacing=0.005, settings=FLAT)


def cliff():
    z = rough(0.01)
    z[:, N // 2 :] += 3.0
    return Extreme(z)


def few_nodes():
    return Extreme(rough(shape=(16, 16)))


def few_nodes_against_plane():
    return Extreme(rough(shape=(16, 16)), settings=FLAT)


def fewest_nodes():
    return Extreme(rough(shape=(8, 8)), settings=FLAT)


def odd_nodes():
    return Extreme(rough(shape=(17, 23)))


def long_strip():
    """4000 x 50."""
    y, x = np.indices((50, 4000))
    z = 0.05 * np.sin(0.3 * x) * np.cos(0.2 * y) + noise(0.01, shape=(50, 4000))
    return Extreme(z)


def tall_strip():
    return Extreme(long_strip().lower[:, :600].T.copy(), settings=FLAT)


def strip_window():
    """An oblong window, ten times as long as wide."""
    return Extreme(rough(shape=(32, 400)), settings={"window": ["1.6 mm", "16 mm"]})


def fine_step():
    z = rough(1e-6)
    z[: N // 2] += 0.02
    return Extreme(z)


def staircase():
    _, x = axes()
    return Extreme(np.floor(x / 0.8) * 0.05 + noise(1e-4))


def quantised():
    """Three heights alone, as of an instrument with too few bits."""
    return Extreme(np.round(rough(0.05) / 0.05) * 0.05)


def two_plateaus():
    z = np.zeros((N, N))
    z[16:32, 16:48] = 0.02
    return Extreme(z)


def two_plateaus_against_plane():
    return Extreme(two_plateaus().lower, settings=FLAT)


def checkerboard():
    y, x = np.indices((N, N))
    return Extreme(0.01 * ((x + y) % 2))


def saw_teeth():
    """Nearly periodic along x, alike along y."""
    _, x = axes()
    return Extreme((x % 0.8) * 0.2 + noise(1e-4))


def extruded():
    """Exactly alike along y: a profile."""
    return Extreme(np.tile(rough()[0], (N, 1)))


def corrugated():
    """Exactly periodic."""
    _, x = axes()
    return Extreme(0.05 * np.sin(2 * np.pi * x / 0.8) + 0 * x)


def egg_box():
    y, x = axes()
    return Extreme(0.05 * np.sin(2 * np.pi * x / 0.8) * np.sin(2 * np.pi * y / 0.8))


def bowl():
    """A paraboloid, smooth."""
    y, x = axes()
    return Extreme(0.01 * ((x - 3.2) ** 2 + (y - 3.2) ** 2), settings=FLAT)


def dome():
    y, x = axes()
    return Extreme(-0.01 * ((x - 3.15) ** 2 + (y - 3.15) ** 2), settings=FLAT)


def one_column_missing():
    z = rough()
    z[:, 40] = np.nan
    return Extreme(z)


def one_row_left_out_of_pair():
    lower = rough()
    upper = lower + rough(0.01, seed=4) + 0.2
    upper[30] = np.nan
    return Extreme(lower, upper)


def mostly_holes():
    z = rough(shape=(96, 96))
    z[np.random.default_rng(1).random(z.shape) < 0.3] = np.nan
    z[30:60, 30:60] = rough(shape=(30, 30), seed=5)
    return Extreme(z)


def huge_offset():
    """Heights over the sea level of another planet."""
    return Extreme(rough() + 1e6)


def huge_tilt():
    y, x = axes()
    return Extreme(rough() + 30 * x + 10 * y)


def written_in_femtometres():
    return Extreme(rough() * 1e12, unit="fm")


def written_in_kilometres():
    return Extreme(rough() * 1e-6, unit="km")


def large_field():
    """Cells of 50 mm: a fault face."""
    return Extreme(rough(5.0), spacing=50.0)


def tiny_field():
    """Cells of 1 nm: an atomic-force microscope."""
    return Extreme(rough(1e-6), spacing=1e-6)


def mated_faces():
    """Two scans, identical."""
    lower = rough()
    return Extreme(lower, lower.copy())


def mated_polished():
    lower = rough(1e-8)
    return Extreme(lower, lower.copy())


def mated_with_gap():
    lower = rough()
    return Extreme(lower, lower + 5.0)


def unrelated_faces():
    return Extreme(rough(), rough(seed=9) + 1.0, options={"registration": "none"})


def white_noise():
    return Extreme(noise(0.01))


def very_smooth():
    """A Hurst exponent of 1 and beyond: hills alone."""
    return Extreme(rough(hurst=0.99, roll_off=3.0))


def soft_rock():
    soft = {"modulus": "1 MPa", "poisson": 0.49, "basic_friction_angle": "30 deg"}
    return Extreme(rough(), settings={"material": soft})


def capped():
    """A hardness that the loads nearly reach everywhere."""
    return Extreme(rough(), settings={"material": ROCK | {"hardness": "150 MPa"}})


def one_load():
    return Extreme(rough(), settings={"loads": ["5 MPa"]})


def feeble_loads():
    return Extreme(rough(), settings={"loads": ["1e-9 MPa", "1e-6 MPa"]})


def crushing_loads():
    """Full contact by the load, not by the face."""
    return Extreme(rough(), settings={"loads": ["1 GPa", "100 GPa", "1000 GPa"]})


def one_offset():
    return Extreme(rough(), settings={"offsets": ["0.3 mm"]})


def no_sliding():
    return Extreme(rough(), settings={"offsets": ["0 mm"]})


def coarse_resolutions():
    return Extreme(rough(), settings={"resolutions": [1, 2, 4, 8, 16]})


def no_friction_angle():
    """A material without what strength needs."""
    return Extreme(rough(), settings={"material": {"modulus": "20 GPa", "poisson": 0.2}})


_MADE = (
    plane,
    exactly_level,
    plane_against_plane,
    plane_of_bits,
    constant_of_bits,
    polished,
    polished_against_plane,
    polished_pair,
    polished_noise,
    femtometres,
    femtometres_against_plane,
    picometre_pair,
    one_spike,
    one_spike_against_plane,
    spike_on_rough,
    four_spikes,
    one_pit,
    steep,
    steep_against_plane,
    three_digit_slopes,
    cliff,
    few_nodes,
    few_nodes_against_plane,
    fewest_nodes,
    odd_nodes,
    long_strip,
    tall_strip,
    strip_window,
    fine_step,
    staircase,
    quantised,
    two_plateaus,
    two_plateaus_against_plane,
    checkerboard,
    saw_teeth,
    extruded,
    corrugated,
    egg_box,
    bowl,
    dome,
    one_column_missing,
    one_row_left_out_of_pair,
    mostly_holes,
    huge_offset,
    huge_tilt,
    written_in_femtometres,
    written_in_kilometres,
    large_field,
    tiny_field,
    mated_faces,
    mated_polished,
    mated_with_gap,
    unrelated_faces,
    white_noise,
    very_smooth,
    soft_rock,
    capped,
    one_load,
    feeble_loads,
    crushing_loads,
    one_offset,
    no_sliding,
    coarse_resolutions,
    no_friction_angle,
)
#: Every case by name.
EXTREMES: dict[str, Callable[[], Extreme]] = {case.__name__: case for case in _MADE}


def write_extreme(folder, case: Extreme, name: str):
    """Write the scan files of a case as a user would drop them in.

    Returns
    -------
    lower, upper : Path
        ``upper`` is None where one face was scanned.
    options, settings : dict
        What its sidecar says of the file, and of the specimen.
    """
    ending = "npy" if case.upper is None else "lower.npy"
    lower, upper = folder / f"{name}.{ending}", None
    np.save(lower, case.lower)
    if case.upper is not None:
        upper = folder / f"{name}.upper.npy"
        np.save(upper, case.upper)
    units = {"unit_xy": "mm", "unit_z": case.unit, "spacing": case.spacing}
    options = {**ARRAY, **units, **case.options}
    return lower, upper, options, case.settings
