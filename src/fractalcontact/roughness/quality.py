"""Quality of a scan: relief, missing cells, noise floor, and the resolutions that go below it."""

import json
import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from ..core.datasets import labelled
from ..core.directions import APERTURE
from ..core.estimate import NO_ESTIMATE, Estimate
from ..core.labels import cf_attrs
from ..core.per_curve import stacked
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
#: Bounds on the side, mm, and on rms slopes at the spacing of the scan: beyond them a unit is
#: nearly always wrong.
MIN_SIDE = 1.0
MIN_SLOPE, MAX_SLOPE = 0.01, 3.0
#: Bins of the histogram, between the outer two percentiles and a quarter beyond on either side.
BINS = 60
#: Least number of cells over number of levels of a surface whose height step can be seen.
CELLS_PER_LEVEL = 2
#: Largest rms departure of heights from multiples of a step, as a fraction of the step.
STEP_TOLERANCE = 0.05
#: Largest rounding error of equal heights, as a fraction of the largest height.
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
        ("scan", "window"): their overlap and their gap. Attribute ``warning``: the warnings of the
        files and of this function in sentences, "" without any; further attributes are those of
        :func:`roughness.quality_words.statements`.

    Notes
    -----
    The shortest wave that nodes at a distance s can show is 2 s long (Nyquist), so a resolution
    lies below the fractal range where 2 s < `range_end`.
    """
    faces = [face for face in ("lower", "upper") if face in specimen]
    spacing = spacing_of(specimen)
    heights = [specimen[face].values.astype(float) for face in faces]
    plane, edges = _removed_plane(specimen), _edges(heights)
    rows = [
        {
            **_relief(z, edges),
            "height_step": height_step(z + plane),
            "point_pitch": _point_pitch(specimen, face),
            **dict(zip(_RADIAL, radial_spectrum(z, spacing), strict=True)),
        }
        for face, z in zip(faces, heights, strict=True)
    ]
    bins = {
        "percentile": list(PERCENTILES),
        "edge": edges,
        "bin_height": (edges[1:] + edges[:-1]) / 2,
    }
    result = xr.Dataset(
        {
            **stacked(rows, {**_RELIEF, **_POINTS, **_RADIAL}, ("face",), (len(faces),)),
            **labelled(_BINS, bins),
            **labelled(ALTERNATION, alternations(heights)),
            **_profile_spectra(heights, spacing),
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

    The slope of an aperture map is not judged, because it is no face.
    """
    side = min(n * s for n, s in zip(heights[0].shape, spacing, strict=True))
    statistics = [slope_statistics(z, spacing) for z in heights]
    rms = max(statistics, key=lambda of_face: of_face["rms_height"].item())["rms_height"].item()
    slopes = [of_face["rms_slope"].item() for of_face in statistics]
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


# -- relief ----------------------------------------------------------------------------------------

#: Variables of each face: unit, long name, dimensions of arrays.
_RELIEF = {
    "missing_share": ("1", "fraction of cells not measured"),
    "rms": ("mm", "root mean square height"),
    "skewness": ("1", "skewness of the heights"),
    "kurtosis": ("1", "kurtosis of the heights, 3 if Gaussian"),
    "lowest": ("mm", "smallest height"),
    "highest": ("mm", "largest height"),
    "height": ("mm", "height", "percentile"),
    "density": (
        "mm-1",
        "fraction of cells in a bin, over its width; some heights lie beyond all bins",
        "bin",
    ),
}
_POINTS = {
    "height_step": ("mm", "step of quantised heights, missing if none is seen"),
    "point_pitch": ("mm", "mean distance of the points measured"),
}
_RADIAL = {
    "radial_wavelength": ("mm", "wavelength", "radial_wave"),
    "radial_spectrum": ("mm4", "radially averaged power spectral density", "radial_wave"),
}
_BINS = {
    "percentile": ("percentile", "%", "fraction of cells below"),
    "edge": ("edge", "mm", "edges of the bins of heights"),
    "bin_height": ("bin", "mm", "middle of the bin of heights"),
}


def _edges(heights):
    """Edges of the bins of all faces' heights, mm, beyond the outer percentiles by a quarter."""
    outer = (PERCENTILES[0], PERCENTILES[-1])
    ends = np.array([np.percentile(z[np.isfinite(z)], outer) for z in heights])
    low, high = ends[:, 0].min(), ends[:, 1].max()
    return np.linspace(low - (high - low) / 4, high + (high - low) / 4, BINS + 1)


def _relief(z, edges) -> dict[str, Any]:
    """Statistics of a face about its mean plane, and its histogram."""
    measured = z[np.isfinite(z)]
    centred = measured - measured.mean()
    rms = np.sqrt(np.mean(centred**2))
    return {
        "missing_share": np.isnan(z).mean(),
        "rms": rms,
        "skewness": np.mean(centred**3) / np.power(rms, 3),
        "kurtosis": np.mean(centred**4) / np.power(rms, 4),
        "lowest": measured.min(),
        "highest": measured.max(),
        "height": np.percentile(measured, PERCENTILES),
        "density": np.histogram(measured, edges)[0] / (measured.size * np.diff(edges)),
    }


def _removed_plane(specimen):
    """Plane (ny, nx) removed by levelling, mm; added back to find the step of a converter."""
    attrs = specimen.attrs
    slopes = attrs["plane_slope_y"] * specimen.y + attrs["plane_slope_x"] * specimen.x
    return (slopes + attrs["plane_offset_mm"]).transpose("y", "x").values


def height_step(heights: np.ndarray) -> float:
    """Step of which all heights are multiples, mm: of a converter, or of rounded text.

    NaN where there are about as many heights as cells, or they share no step. Heights are as
    measured, before a plane is taken off; NaN where missing.
    """
    measured = np.sort(heights[np.isfinite(heights)])
    rises = np.diff(measured)
    steps = rises[rises > ROUNDING * np.abs(measured).max(initial=0)]
    if steps.size < 2 or measured.size < CELLS_PER_LEVEL * (steps.size + 1):
        return math.nan
    step = np.median(steps[steps < 1.5 * steps.min()])
    multiples = np.round((measured - measured[0]) / step)
    step = np.dot(multiples, measured - measured[0]) / np.dot(multiples, multiples)
    left = measured - measured[0] - step * multiples
    return float(step) if np.sqrt(np.mean(left**2)) < STEP_TOLERANCE * step else math.nan


# -- spectra ---------------------------------------------------------------------------------------


#: Variables along each axis of each face: unit, long name, dimensions of arrays.
_PROFILES = {
    "wavelength": ("mm", "wavelength", "wave"),
    "spectrum": ("mm3", "two-sided power spectral density of profiles", "wave"),
    "spectrum_model": ("mm3", "its model: self-affine, with what else was seen", "wave"),
    "noise_rms": ("mm", "noise floor: standard deviation of independent errors of the nodes"),
    "noise_wavelength": ("mm", "wavelength where the self-affine line meets the noise floor"),
    "filter_wavelength": ("mm", "wavelength where a low-pass filter halves the spectrum"),
    "roll_off_wavelength": ("mm", "wavelength above which the spectrum is flat"),
    "end": ("mm", "shortest wavelength of the fractal range along one axis"),
    "noise_limit": ("mm", "upper bound of the noise floor"),
    "strips_left_out": (
        "1",
        f"strips of profiles, of {STRIPS}, left out for spikes or steps, mean over the wavelengths",
    ),
    "misfit": ("1", "rms logarithm of measured over modelled spectrum"),
    "line_level": ("mm3", "self-affine line at a wavelength of 1 mm"),
    "line_exponent": ("1", "exponent 1 + 2H of the self-affine line"),
    "form": ("1", "parts of the model of the spectrum"),
    "self_affine_line": ("mm3", "self-affine line at the wavelengths", "wave"),
    "noise_floor": ("mm3", "noise floor of the spectrum of profiles"),
}


def _profile_spectrum(curve, spacing) -> dict[str, Any]:
    """Values of :data:`_PROFILES` of a curve of :func:`roughness.spectra.profile_spectra`."""
    fractal = find_fractal_range(curve, spacing)
    level, exponent = fractal.line
    return {
        "wavelength": curve.length,
        "spectrum": fractal.level,
        "spectrum_model": fractal.fitted,
        "noise_rms": fractal.noise_rms,
        "noise_wavelength": fractal.noise_wavelength,
        "filter_wavelength": fractal.filter_wavelength,
        "roll_off_wavelength": fractal.roll_off_wavelength,
        "end": fractal.end,
        "noise_limit": fractal.noise_limit,
        "strips_left_out": fractal.left_out,
        "misfit": fractal.misfit,
        "line_level": level,
        "line_exponent": exponent,
        "form": _form_words(fractal),
        "self_affine_line": level * curve.length**exponent,
        "noise_floor": np.square(fractal.noise_rms.value) * spacing,
    }


def _profile_spectra(heights, spacing):
    """Spectra of profiles along x and y, and the ends of their fractal range."""
    along = dict(zip(AXES, spacing[::-1], strict=True))
    rows = [
        _profile_spectrum(curve, along[axis])
        for z in heights
        for axis, curve in profile_spectra(z, spacing).items()
    ]
    return stacked(rows, _PROFILES, ("face", "axis"), (len(heights), len(AXES)))


def _form_words(fractal_range: FractalRange) -> str:
    """Model of a spectrum in words; "" without one."""
    if fractal_range.form is None:
        return ""
    form = fractal_range.form
    parts = ["self-affine" if form.sampling == "ideal" else f"self-affine, {form.sampling}"]
    parts += ["roll-off"] * form.rolls_off + ["noise floor"] * form.noisy
    return " + ".join(parts + ([f"{form.filtering} low-pass"] if form.filtering else []))


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

    A distance of points larger than that of the nodes ends the range too.
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
    determined = [end for end in ends if end.known]
    return max(determined, key=lambda end: (*end.ends, end.reason), default=NO_ESTIMATE)


def _compared_with_range(end: Estimate, resolutions, side):
    """End of the range, and the resolutions that go below it."""
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
