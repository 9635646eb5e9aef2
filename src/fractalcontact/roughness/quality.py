"""Quality of a scan: relief, missing cells, noise floor, and the resolutions that go below it."""

import json
import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import chain
from operator import attrgetter
from typing import Any

import numpy as np
import xarray as xr

from ..core.arrays import padded
from ..core.datasets import labelled
from ..core.directions import APERTURE
from ..core.estimate import NO_ESTIMATE, Estimate
from ..core.labels import cf_attrs
from ..core.text import length_words
from ..core.window import cell_side, face_words, spacing_of
from .dimension import slope_statistics
from .face_gap import REGIONS, gap_statistics
from .fractal_range import FractalRange, find_fractal_range
from .quality_words import AXES, file_warnings, interval_words, statements
from .scan_lines import ALTERNATION, alternations, scan_line_warnings
from .spectra import STRIPS, profile_spectra, radial_spectrum

#: Fractions of the cells below a height, in percent.
PERCENTILES = (0.1, 1.0, 5.0, 25.0, 50.0, 75.0, 95.0, 99.0, 99.9)
#: mm, and rms slopes at the spacing of the scan, beyond which a unit is wrong, nearly always.
MIN_SIDE = 1.0
MIN_SLOPE, MAX_SLOPE = 0.01, 3.0
#: Bins of the histogram, between the outer two percentiles and a quarter beyond on either side.
BINS = 60
#: Levels of a quantised surface are at least this many times fewer than its cells, or the step is
#: too fine to be seen.
CELLS_PER_LEVEL = 2
#: Heights are multiples of a step when they depart from them by less than this part of it (rms).
STEP_TOLERANCE = 0.05
#: What arithmetic may add to equal heights, as a part of the largest.
ROUNDING = 1e-13


def scan_quality(specimen: xr.Dataset, resolutions: Sequence[int]) -> xr.Dataset:
    """Relief, spectra and noise of each scanned face.

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
        averaged spectrum. On `face` and `axis`: spectra of profiles, the fractal range by
        :mod:`roughness.fractal_range`, and alternate scan lines by :mod:`roughness.scan_lines`.
        `range_end` (mm), the shortest wavelength of the fractal range over all of them, with its
        cause as attribute ``ended_by``; `below_range` on `resolution`. Of two faces, on `region`
        ("scan", "window"): where they overlap, and their gap. Attributes: ``warning``, what
        reading the files and this found, in sentences, "" if all is well; ``overlap``, a clause on
        where the faces overlap, "" of one face; what :func:`roughness.quality_words.statements`
        says.

    Notes
    -----
    The shortest wave that nodes at a distance s can show is 2 s long (Nyquist), so a resolution
    lies below the fractal range where 2 s < `range_end`.
    """
    faces = [face for face in ("lower", "upper") if face in specimen]
    spacing = spacing_of(specimen)
    heights = [specimen[face].values.astype(float) for face in faces]
    plane = _removed_plane(specimen)
    points = {
        "height_step": [height_step(z + plane) for z in heights],
        "point_pitch": [_point_pitch(specimen, face) for face in faces],
    }
    result = xr.Dataset(
        {
            **_relief(heights),
            **labelled(_POINTS, points),
            **labelled(ALTERNATION, alternations(heights)),
            **_profile_spectra(heights, spacing),
            **_radial_spectra(heights, spacing),
        },
        coords={"face": faces, "axis": list(AXES)},
    )
    floor = (result["noise_rms"].min("axis", skipna=False) ** 2 * np.prod(spacing)).assign_attrs(
        cf_attrs("mm4", "noise floor of the radially averaged spectrum")
    )
    result["radial_noise_floor"] = floor
    if len(faces) == 2:
        result = result.assign(gap_statistics(specimen)).assign_coords(region=list(REGIONS))
    side = cell_side(specimen)
    end = _range_end(result, specimen)
    result = result.assign(_compared_with_range(end, np.array(resolutions), side))
    result.attrs = {"ended_by": end.reason}
    warnings = [*file_warnings(specimen), *scan_line_warnings(result), _warning(result)]
    warnings.append(_doubtful_unit(specimen, heights, spacing))
    result.attrs["warning"] = "; ".join(filter(None, warnings))
    result.attrs |= {f"spacing_{axis}": specimen.attrs[f"spacing_{axis}"] for axis in AXES}
    return result.assign_attrs(statements(specimen, result))


def _doubtful_unit(specimen, heights, spacing) -> str:
    """Warning of a side or slope that rock joints hardly have: a wrong unit, nearly always.

    The slope of an aperture map is not judged: it is no face.
    """
    side = min(n * s for n, s in zip(heights[0].shape, spacing, strict=True))
    found = [slope_statistics(z, spacing) for z in heights]
    rms = max(found, key=lambda one: one["rms_height"].item())["rms_height"].item()
    slopes = [one["rms_slope"].item() for one in found]
    is_slope = specimen.attrs["opposite"] != APERTURE and any(
        not MIN_SLOPE <= slope <= MAX_SLOPE for slope in slopes if math.isfinite(slope)
    )
    if side >= MIN_SIDE and not is_slope:
        return ""
    words = " and ".join(f"{slope:.2g}" for slope in slopes)
    return (
        f"is this a rock joint? Its side is {length_words(side)}, its rms height "
        f"{length_words(rms)}, its rms slope {words}; check 'unit', 'unit_xy', 'unit_z' and "
        "'spacing' in the sidecar"
    )


_POINTS = {
    "height_step": ("face", "mm", "step of quantised heights, missing if none is seen"),
    "point_pitch": ("face", "mm", "mean distance of the points measured"),
}


# -- relief ----------------------------------------------------------------------------------------

_RELIEF = {
    "missing_share": ("face", "1", "fraction of cells not measured"),
    "rms": ("face", "mm", "root mean square height"),
    "skewness": ("face", "1", "skewness of the heights"),
    "kurtosis": ("face", "1", "kurtosis of the heights, 3 if Gaussian"),
    "lowest": ("face", "mm", "smallest height"),
    "highest": ("face", "mm", "largest height"),
    "percentile": ("percentile", "%", "fraction of cells below"),
    "height": (("face", "percentile"), "mm", "height"),
    "edge": ("edge", "mm", "edges of the bins of heights"),
    "bin_height": ("bin", "mm", "middle of the bin of heights"),
    "density": (
        ("face", "bin"),
        "mm-1",
        "fraction of cells in a bin, over its width; some heights lie beyond all bins",
    ),
}


def _relief(heights):
    """Statistics about the mean plane, and histograms of all faces over the same bins."""
    known = [z[np.isfinite(z)] for z in heights]
    centred = [z - z.mean() for z in known]
    rms = np.array([np.sqrt(np.mean(z**2)) for z in centred])
    percentiles = np.array([np.percentile(z, PERCENTILES) for z in known])
    low, high = percentiles[:, 0].min(), percentiles[:, -1].max()
    edges = np.linspace(low - (high - low) / 4, high + (high - low) / 4, BINS + 1)
    counts = np.array([np.histogram(z, edges)[0] for z in known])
    values = {
        "missing_share": [np.isnan(z).mean() for z in heights],
        "rms": rms,
        "skewness": _moment(centred, 3) / rms**3,
        "kurtosis": _moment(centred, 4) / rms**4,
        "lowest": [z.min() for z in known],
        "highest": [z.max() for z in known],
        "percentile": list(PERCENTILES),
        "height": percentiles,
        "edge": edges,
        "bin_height": (edges[1:] + edges[:-1]) / 2,
        "density": counts / (np.array([[z.size] for z in known]) * np.diff(edges)),
    }
    return labelled(_RELIEF, values)


def _moment(centred, order):
    return np.array([np.mean(z**order) for z in centred])


def _removed_plane(specimen):
    """Plane (ny, nx) removed by levelling, mm; added back to find the step of a converter."""
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


_AXIS = ("face", "axis")

_PROFILES = {
    "wavelength": ((*_AXIS, "wave"), "mm", "wavelength"),
    "spectrum": ((*_AXIS, "wave"), "mm3", "two-sided power spectral density of profiles"),
    "spectrum_model": (
        (*_AXIS, "wave"),
        "mm3",
        "its model: self-affine, with what else was seen",
    ),
}

#: Estimates with their intervals.
_ESTIMATES = {
    "noise_rms": ("mm", "noise floor: standard deviation of independent errors of the nodes"),
    "noise_wavelength": ("mm", "wavelength where the self-affine line meets the noise floor"),
    "filter_wavelength": ("mm", "wavelength where a low-pass filter halves the spectrum"),
    "roll_off_wavelength": ("mm", "wavelength above which the spectrum is flat"),
    "end": ("mm", "shortest wavelength of the fractal range along one axis"),
}

_NUMBERS = {
    "noise_limit": (_AXIS, "mm", "upper bound of the noise floor"),
    "strips_left_out": (
        _AXIS,
        "1",
        f"strips of profiles, of {STRIPS}, left out for spikes or steps, mean over the wavelengths",
    ),
    "misfit": (_AXIS, "1", "rms logarithm of measured over modelled spectrum"),
    "line_level": (_AXIS, "mm3", "self-affine line at a wavelength of 1 mm"),
    "line_exponent": (_AXIS, "1", "exponent 1 + 2H of the self-affine line"),
    "form": (_AXIS, "1", "parts of the model of the spectrum"),
    "self_affine_line": ((*_AXIS, "wave"), "mm3", "self-affine line at the wavelengths"),
    "noise_floor": (_AXIS, "mm3", "noise floor of the spectrum of profiles"),
}


def _profile_spectra(heights, spacing):
    """Spectra of profiles along x and y, and where their fractal range ends."""
    curves = [list(profile_spectra(z, spacing).values()) for z in heights]  # x, then y
    ranges = [
        [find_fractal_range(curve, d) for curve, d in zip(row, spacing[::-1], strict=True)]
        for row in curves
    ]

    def of_range(value):
        return [[value(found) for found in row] for row in ranges]

    profiles = {
        "wavelength": _padded_rows([[curve.length for curve in row] for row in curves]),
        "spectrum": _padded_rows(of_range(lambda found: found.level)),
        "spectrum_model": _padded_rows(of_range(lambda found: found.fitted)),
    }
    estimates: dict[str, Any] = {}
    for name, words in _ESTIMATES.items():
        each = chain.from_iterable(of_range(attrgetter(name)))
        estimates |= Estimate.stack(each, (len(ranges), len(AXES))).variables(name, _AXIS, *words)
    level = np.array(of_range(lambda found: found.line[0]))
    exponent = np.array(of_range(lambda found: found.line[1]))
    noise = np.array(of_range(lambda found: found.noise_rms.value))
    waves = profiles["wavelength"]
    numbers = {
        "self_affine_line": level[..., np.newaxis] * waves ** exponent[..., np.newaxis],
        "noise_floor": noise**2 * np.array(spacing[::-1]),
        "noise_limit": of_range(lambda found: found.noise_limit),
        "strips_left_out": of_range(lambda found: found.left_out),
        "misfit": of_range(lambda found: found.misfit),
        "line_level": level,
        "line_exponent": exponent,
        "form": of_range(_form_words),
    }
    return {
        **labelled(_PROFILES, profiles),
        **estimates,
        **labelled(_NUMBERS, numbers),
    }


def _form_words(found: FractalRange) -> str:
    """Model of a spectrum in words; "" without one."""
    if found.form is None:
        return ""
    form = found.form
    parts = ["self-affine" if form.sampling == "ideal" else f"self-affine, {form.sampling}"]
    parts += ["roll-off"] * form.rolls_off + ["noise floor"] * form.noisy
    return " + ".join(parts + ([f"{form.filtering} low-pass"] if form.filtering else []))


def _padded_rows(values):
    """Rows of rows of arrays of different length as one array (face, axis, wave)."""
    flat = padded([array for row in values for array in row])
    return flat.reshape(len(values), len(AXES), -1)


_RADIAL = {
    "radial_wavelength": (("face", "radial_wave"), "mm", "wavelength"),
    "radial_spectrum": (
        ("face", "radial_wave"),
        "mm4",
        "radially averaged power spectral density",
    ),
}


def _radial_spectra(heights, spacing):
    wavelengths, densities = zip(*(radial_spectrum(z, spacing) for z in heights), strict=True)
    return labelled(
        _RADIAL, {"radial_wavelength": padded(wavelengths), "radial_spectrum": padded(densities)}
    )


# -- where the fractal range ends ------------------------------------------------------------------


def _point_pitch(specimen, face):
    """Side of the square each point of a cloud or mesh has, mm; NaN of a matrix."""
    attrs = json.loads(specimen.attrs[f"{face}_scan"])
    points = attrs.get("points", 0) - attrs.get("duplicated_points", 0)
    if points <= 0:
        return math.nan
    return cell_side(specimen) * math.sqrt(float(specimen[face].notnull().sum()) / points)


_RANGE = {
    "resolution": ("resolution", "mm", "spacing s of the nodes"),
    "below_range": ("resolution", "1", "shortest wave 2 s lies below the fractal range"),
}


def _range_end(result, specimen) -> Estimate:
    """Shortest wavelength of the fractal range, mm, over faces and axes, and its cause.

    Points farther apart than the nodes end it too.
    """
    seen = Estimate.read(result, "end")
    words = [face_words(specimen, face) for face in result["face"].values]
    ends = [
        replace(seen[i, j], reason=f"{_cause(result, i, j)} along {axis}, {face}")
        for i, face in enumerate(words)
        for j, axis in enumerate(AXES)
    ]
    ends += [
        Estimate(2 * float(pitch), reason=f"distance of the points, {face}")
        for face, pitch in zip(words, result["point_pitch"], strict=True)
        if pitch > cell_side(specimen)
    ]
    known = [end for end in ends if end.known]
    return max(known, key=lambda end: (*end.ends, end.reason), default=NO_ESTIMATE)


def _compared_with_range(end: Estimate, resolutions, side):
    """The end of the range, and the resolutions that go below it."""
    values = {
        "resolution": resolutions * side,
        "below_range": 2 * (resolutions * side) < end.value,
    }
    words = "shortest wavelength of the fractal range"
    return labelled(_RANGE, values) | end.variables("range_end", (), "mm", words)


def _cause(result, i, j):
    """End of the fractal range along one axis of one face, and its cause."""
    filtered = result["filter_wavelength"][i, j]
    return "low-pass filter" if filtered == result["end"][i, j] else "noise floor"


def _warning(result) -> str:
    below = result["below_range"].values
    if not below.any():
        return ""
    sides = [f"{s:.3g}" for s in result["resolution"].values[below]]
    waves = [f"{2 * s:.3g}" for s in result["resolution"].values[below]]
    return (
        f"spacings of {', '.join(sides)} mm are finer than the scan resolves: their shortest "
        f"waves, {', '.join(waves)} mm, lie below the end of the fractal range at "
        f"{interval_words(result, 'range_end', 'mm')} ({result.attrs['ended_by']})"
    )
