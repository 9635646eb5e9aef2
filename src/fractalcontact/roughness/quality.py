"""How good a scan is: relief, missing cells, noise floor, and which resolutions go below it."""

import json
import math

import numpy as np
import xarray as xr

from ..core.arrays import padded
from ..core.intervals import INTERVAL
from ..core.labels import cf_attrs
from ..surface.grid import spacing_of
from ..surface.specimen import cell_side
from .fractal_range import FractalRange, find_fractal_range
from .quality_words import AXES, interval_words
from .spectra import STRIPS, profile_spectra, radial_spectrum

#: Shares of the cells below a height, in percent.
PERCENTILES = (0.1, 1.0, 5.0, 25.0, 50.0, 75.0, 95.0, 99.0, 99.9)
#: Bins of the histogram, between the outer two percentiles and a quarter beyond on either side.
BINS = 60
#: Levels of a quantised surface are at least this many times fewer than its cells, or the step is
#: too fine to be seen.
CELLS_PER_LEVEL = 2
#: Heights are multiples of a step when they depart from them by less than this part of it (rms).
STEP_TOLERANCE = 0.05
#: What arithmetic may add to equal heights, as a part of the largest.
ROUNDING = 1e-13


def scan_quality(specimen: xr.Dataset, resolutions) -> xr.Dataset:
    """Measure relief, spectra and noise of each scanned face.

    Parameters
    ----------
    specimen : Dataset
        From :func:`surface.specimen.make_specimen`.
    resolutions : sequence of int
        Multiples k of the spacing the study uses.

    Returns
    -------
    Dataset
        On `face`: relief and histogram (`edge`, `bin`), `missing_share`, `height_step`, radially
        averaged spectrum. On `face` and `axis`: spectra of profiles and what
        :mod:`roughness.fractal_range` finds in them. `range_end` (mm), the shortest wavelength
        of the fractal range over all of them, with what it comes from as attribute ``ended_by``;
        `below_range` on `resolution`. Attribute ``warning``: a sentence, "" if all is well.

    Notes
    -----
    The shortest wave that nodes at a distance s can show is 2 s long (Nyquist), so a resolution
    lies below the fractal range where 2 s < `range_end`.
    """
    faces = [face for face in ("lower", "upper") if face in specimen]
    spacing = spacing_of(specimen)
    heights = {face: specimen[face].values.astype(float) for face in faces}
    result = xr.Dataset(coords={"face": faces, "axis": list(AXES)})
    _add_relief(result, list(heights.values()))
    result["height_step"] = (
        "face",
        [height_step(z + _removed_plane(specimen)) for z in heights.values()],
        cf_attrs("mm", "step of quantised heights, missing if none is seen"),
    )
    _add_profile_spectra(result, list(heights.values()), spacing)
    _add_radial_spectra(result, list(heights.values()), spacing)
    pitch = [_point_pitch(specimen, face) for face in faces]
    result["point_pitch"] = "face", pitch, cf_attrs("mm", "mean distance of the points measured")
    _add_range_end(result, np.array(resolutions), cell_side(specimen))
    result.attrs |= {f"spacing_{axis}": specimen.attrs[f"spacing_{axis}"] for axis in AXES}
    return result


# -- relief ----------------------------------------------------------------------------------------


def _add_relief(result, heights):
    """Statistics about the mean plane, and histograms of all faces over the same bins."""
    known = [z[np.isfinite(z)] for z in heights]
    centred = [z - z.mean() for z in known]
    rms = np.array([np.sqrt(np.mean(z**2)) for z in centred])
    moments = {
        "missing_share": (
            "1",
            "share of cells not measured",
            [np.isnan(z).mean() for z in heights],
        ),
        "rms": ("mm", "root mean square height", rms),
        "skewness": ("1", "skewness of the heights", _moment(centred, 3) / rms**3),
        "kurtosis": ("1", "kurtosis of the heights, 3 if Gaussian", _moment(centred, 4) / rms**4),
        "lowest": ("mm", "smallest height", [z.min() for z in known]),
        "highest": ("mm", "largest height", [z.max() for z in known]),
    }
    for name, (units, words, values) in moments.items():
        result[name] = "face", np.asarray(values, float), cf_attrs(units, words)
    result["percentile"] = "percentile", list(PERCENTILES), cf_attrs("%", "share of cells below")
    percentiles = np.array([np.percentile(z, PERCENTILES) for z in known])
    result["height"] = ("face", "percentile"), percentiles, cf_attrs("mm", "height")
    low, high = percentiles[:, 0].min(), percentiles[:, -1].max()
    edges = np.linspace(low - (high - low) / 4, high + (high - low) / 4, BINS + 1)
    counts = np.array([np.histogram(z, edges)[0] for z in known])
    result["edge"] = "edge", edges, cf_attrs("mm", "edges of the bins of heights")
    result["density"] = (
        ("face", "bin"),
        counts / (np.array([[z.size] for z in known]) * np.diff(edges)),
        cf_attrs(
            "mm-1", "share of cells in a bin, over its width; some heights lie beyond all bins"
        ),
    )


def _moment(centred, order):
    return np.array([np.mean(z**order) for z in centred])


def _removed_plane(specimen):
    """Plane (ny, nx) that levelling took off, mm: the step of a converter lies in what it left."""
    attrs = specimen.attrs
    slopes = attrs["plane_slope_y"] * specimen.y + attrs["plane_slope_x"] * specimen.x
    return (slopes + attrs["plane_offset_mm"]).transpose("y", "x").values


def height_step(heights: np.ndarray) -> float:
    """The step of which all heights are multiples, mm: of a converter, or of rounded text.

    Parameters
    ----------
    heights : (ny, nx) ndarray
        As measured, before a plane is taken off; NaN where missing.

    Returns
    -------
    float
        NaN where there are about as many heights as cells, or they share no step.
    """
    known = np.sort(heights[np.isfinite(heights)])
    rises = np.diff(known)
    steps = rises[rises > ROUNDING * np.abs(known).max(initial=0)]
    if steps.size < 2 or known.size < CELLS_PER_LEVEL * (steps.size + 1):
        return math.nan
    step = np.median(steps[steps < 1.5 * steps.min()])
    multiples = np.round((known - known[0]) / step)
    step = np.dot(multiples, known - known[0]) / np.dot(multiples, multiples)
    left = known - known[0] - step * multiples
    return float(step) if np.sqrt(np.mean(left**2)) < STEP_TOLERANCE * step else math.nan


# -- spectra ---------------------------------------------------------------------------------------


def _add_profile_spectra(result, heights, spacing):
    """Spectra of profiles along x and y, and where their fractal range ends."""
    curves = [list(profile_spectra(z, spacing).values()) for z in heights]  # x, then y
    found = [
        [find_fractal_range(c, d) for c, d in zip(row, spacing[::-1], strict=True)]
        for row in curves
    ]
    dims = ("face", "axis", "wave")
    for name, units, words, values in (
        ("wavelength", "mm", "wavelength", [[c.length for c in row] for row in curves]),
        (
            "spectrum",
            "mm3",
            "two-sided power spectral density of profiles",
            [[r.level for r in row] for row in found],
        ),
        (
            "spectrum_model",
            "mm3",
            "its model: self-affine, with what else was seen",
            [[r.fitted for r in row] for row in found],
        ),
    ):
        result[name] = dims, _table(values), cf_attrs(units, words)
    for name, units, words in _RANGE_VARIABLES:
        values = np.array([[getattr(r, name) for r in row] for row in found])
        for i, (ending, of) in enumerate(INTERVAL.items()):
            result[name + ending] = ("face", "axis"), values[..., i], cf_attrs(units, words + of)
    for name, units, words, take in _RANGE_NUMBERS:
        values = [[take(r) for r in row] for row in found]
        result[name] = ("face", "axis"), values, cf_attrs(units, words)


_RANGE_VARIABLES = (
    ("noise_rms", "mm", "noise floor: standard deviation of independent errors of the nodes"),
    ("noise_wavelength", "mm", "wavelength where the self-affine line meets the noise floor"),
    ("filter_wavelength", "mm", "wavelength where a low-pass filter halves the spectrum"),
    ("roll_off_wavelength", "mm", "wavelength above which the spectrum is flat"),
    ("end", "mm", "shortest wavelength of the fractal range along one axis"),
)
_RANGE_NUMBERS = (
    ("noise_limit", "mm", "what the noise floor can be at most", lambda r: r.noise_limit),
    (
        "strips_left_out",
        "1",
        f"strips of profiles, of {STRIPS}, left out for spikes or steps, mean over the wavelengths",
        lambda r: r.left_out,
    ),
    ("misfit", "1", "rms logarithm of measured over modelled spectrum", lambda r: r.misfit),
    ("line_level", "mm3", "self-affine line at a wavelength of 1 mm", lambda r: r.line[0]),
    ("line_exponent", "1", "exponent 1 + 2H of the self-affine line", lambda r: r.line[1]),
    ("form", "1", "parts of the model of the spectrum", lambda r: _form_words(r)),
)


def _form_words(found: FractalRange) -> str:
    """The model of a spectrum in words; "" if there is none."""
    if found.form is None:
        return ""
    form = found.form
    parts = ["self-affine" if form.sampling == "ideal" else f"self-affine, {form.sampling}"]
    parts += ["roll-off"] * form.rolls_off + ["noise floor"] * form.noisy
    return " + ".join(parts + ([f"{form.filtering} low-pass"] if form.filtering else []))


def _table(values):
    """Rows of rows of arrays of different length as one array (face, axis, wave)."""
    flat = padded([array for row in values for array in row])
    return flat.reshape(len(values), len(AXES), -1)


def _add_radial_spectra(result, heights, spacing):
    found = [radial_spectrum(z, spacing) for z in heights]
    for i, (name, units, words) in enumerate(
        (
            ("radial_wavelength", "mm", "wavelength"),
            ("radial_spectrum", "mm4", "radially averaged power spectral density"),
        )
    ):
        values = padded([curve[i] for curve in found])
        result[name] = ("face", "radial_wave"), values, cf_attrs(units, words)


# -- where the fractal range ends ------------------------------------------------------------------


def _point_pitch(specimen, face):
    """Side of the square each point of a cloud or mesh has, mm; NaN of a matrix."""
    attrs = json.loads(specimen.attrs[f"{face}_scan"])
    points = attrs.get("points", 0) - attrs.get("duplicated_points", 0)
    if points <= 0:
        return math.nan
    return cell_side(specimen) * math.sqrt(float(specimen[face].notnull().sum()) / points)


def _add_range_end(result, resolutions, side):
    """The end of the range over faces and axes, and the resolutions that go below it."""
    candidates = [
        (
            float(result["end"][i, j]),
            [float(result[f"end{e}"][i, j]) for e in ("_low", "_high")],
            f"{_cause(result, i, j)} along {axis}, {face} face",
        )
        for i, face in enumerate(result["face"].values)
        for j, axis in enumerate(AXES)
    ]
    candidates += [
        (2 * float(pitch), [math.nan] * 2, f"distance of the points, {face} face")
        for face, pitch in zip(result["face"].values, result["point_pitch"], strict=True)
        if pitch > side
    ]
    found = [candidate for candidate in candidates if math.isfinite(candidate[0])]
    end, bounds, cause = max(found, default=(math.nan, [math.nan] * 2, ""))
    words = "shortest wavelength of the fractal range"
    for (ending, of), value in zip(INTERVAL.items(), (end, *bounds), strict=True):
        result[f"range_end{ending}"] = (), value, cf_attrs("mm", words + of)
    result.attrs["ended_by"] = cause
    result["resolution"] = (
        "resolution",
        resolutions * side,
        cf_attrs("mm", "spacing s of the nodes"),
    )
    result["multiple"] = (
        "resolution",
        resolutions,
        cf_attrs("1", "multiple k of the scan's spacing"),
    )
    below = 2 * result["resolution"].values < end
    words = "shortest wave 2 s lies below the fractal range"
    result["below_range"] = "resolution", below, cf_attrs("1", words)
    result.attrs["warning"] = _warning(result)


def _cause(result, i, j):
    """What ends the range along one axis of one face."""
    filtered = result["filter_wavelength"][i, j]
    return "low-pass filter" if filtered == result["end"][i, j] else "noise floor"


def _warning(result) -> str:
    below = result["below_range"].values
    if not below.any():
        return ""
    sides = [f"{s:.3g}" for s in result["resolution"].values[below]]
    waves = [f"{2 * s:.3g}" for s in result["resolution"].values[below]]
    return (
        f"resolutions s = {', '.join(sides)} mm lie below the end of the fractal range: their "
        f"shortest waves of 2 s = {', '.join(waves)} mm are shorter than "
        f"{interval_words(result, 'range_end', 'mm')} ({result.attrs['ended_by']})"
    )
