"""Shaded relief of the levelled faces, and their dimension (Fig. 2)."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LightSource, Normalize, to_rgb
from matplotlib.figure import Figure, FigureBase
from matplotlib.patches import Rectangle
from matplotlib.ticker import MaxNLocator
from scipy.ndimage import distance_transform_edt
from xarray import DataTree

from ...core.estimate import DIMENSION, Estimate, names_of
from ...roughness.recommended import dimension_table
from ..kit.drawing import COLOURS, WIDTH, Drawing, group, heading, headline, letter, settings_of
from ..kit.empty import say_empty
from ..kit.maps import MISSING, draw_map, missing_patch, scan_extent, window_outline
from ..kit.points import reach
from ..kit.words import length_unit, opening, percent

TITLE = "Fig. 2: shaded relief of the levelled faces, and the surface dimension"
SUBJECT = "specimen"
NEEDS = ("specimens", "surface_dimension")
ORDER = 20

COLOUR_MAP = "cividis"
#: Fraction of the heights beyond each end of the colours, so that a spike does not take them all.
CLIPPED = 0.002
#: Heights are stretched for the light so that their rms slope becomes this; not in the colours.
LIT_SLOPE = 0.7


def draw(atlas: DataTree, name: str) -> Drawing:
    """Relief of each face under light from the North-West, and Delta_g by every estimator.

    Its data are the estimates of Delta_g, of the lower face.
    """
    specimen = group(atlas, "specimens", name)
    dimension = group(atlas, "surface_dimension", name)
    label = settings_of(atlas, name)["label"]
    faces = [face for face in ("lower", "upper") if face in specimen]
    sides = scan_extent(specimen)
    missing = [not np.isfinite(specimen[face].values).all() for face in faces]

    columns = len(faces) + 1
    width = WIDTH * (0.55 if len(faces) == 1 else 0.35)
    height = min(max(width * sides[0] / sides[1], 1.6), 1.3 * width) + 1.2
    figure = Figure(figsize=(WIDTH, height))
    ratios = [1.6 if len(faces) == 1 else 1.2] * len(faces) + [1]
    axes = figure.subplots(1, columns, width_ratios=ratios)
    outline = draw_faces(figure, axes[:-1], specimen, faces, sides)
    letters = "ab"[: len(faces)]
    for panel, which, face in zip(axes, letters, faces, strict=False):
        letter(panel, which, f"{face} face")
    estimates = _draw_dimensions(axes[-1], dimension)
    letter(axes[-1], "abc"[len(faces)], r"$\Delta_g$ of the lower face")
    handles = [outline, *([missing_patch()] if any(missing) else []), *estimates]
    handles += map(heading, _fit_words(dimension))
    figure.legend(handles=handles, loc="outside lower left", ncols=3, columnspacing=1)
    headline(figure, label, below=_size_words(specimen, sides))
    return Drawing(figure, _table(dimension), _caption(specimen, faces, dimension))


def draw_faces(
    figure: FigureBase,
    panels: Sequence[Axes],
    specimen: xr.Dataset,
    faces: Sequence[str],
    sides: Sequence[float],
) -> Rectangle:
    """Reliefs side by side with one scale of heights; the outline of the window."""
    heights = np.concatenate([specimen[face].values.ravel() for face in faces])
    low, high = np.nanquantile(heights, [CLIPPED, 1 - CLIPPED])
    _, size = length_unit(max(sides))
    unit_of_height = length_unit(high - low)
    norm = Normalize(low / unit_of_height[1], high / unit_of_height[1])
    spacing = specimen.attrs["spacing_y"], specimen.attrs["spacing_x"]
    for panel, face in zip(panels, faces, strict=True):
        image = _shaded(specimen[face].values, spacing, low, high)
        draw_map(panel, image, sides)
        outline = window_outline(specimen, size, lw=1, label="window of the contact")
        panel.add_patch(outline)
    figure.colorbar(
        ScalarMappable(norm, COLOUR_MAP),
        ax=list(panels),
        location="bottom",
        fraction=0.05,
        aspect=40,
        extend="both",
        label=f"height above the mean plane ({unit_of_height[0]})",
    )
    return outline


def _shaded(heights, spacing, low, high):
    """Colours (ny, nx, 3) of a lit relief; cells not measured are grey."""
    known = np.isfinite(heights)
    # The light must not see a cliff at a hole; what is filled in here is painted over below.
    nearest = distance_transform_edt(~known, return_distances=False, return_indices=True)
    whole = heights[tuple(nearest)]
    steepness = np.sqrt(np.mean(np.square(np.gradient(whole, *spacing))))
    stretch = LIT_SLOPE / steepness if steepness > 0 else 1.0
    colours = LightSource(azdeg=315, altdeg=45).shade(
        # Rows of the image run to the North, the light's to the South: the step in y is negative.
        whole,
        colormaps[COLOUR_MAP],
        vmin=low,
        vmax=high,
        vert_exag=stretch,
        dx=spacing[1],
        dy=-spacing[0],
        blend_mode="soft",
    )[..., :3]
    colours[~known] = to_rgb(MISSING)
    return colours


def _draw_dimensions(axes, dimension):
    """Estimates of Delta_g with their intervals, one below the other; the lines of a legend."""
    values, low, high = Estimate.read(dimension, "dimension").ends
    rows = np.arange(len(values))
    fitted = np.isfinite(values)
    words = [
        f"{estimator.replace('_', ' ')}\n"
        + (Estimate(*numbers, scale=DIMENSION).text() if np.isfinite(numbers[0]) else "no fit")
        for estimator, *numbers in zip(
            dimension["estimator"].values, values, low, high, strict=True
        )
    ]
    axes.set_yticks(rows, words, fontsize=7)
    axes.set_ylim(len(rows) - 0.4, -0.6)
    axes.set_xlabel(r"surface dimension $\Delta_g$ (1)")
    axes.xaxis.set_major_locator(MaxNLocator(4, steps=[1, 2, 5, 10]))
    if not fitted.any():
        say_empty(axes, "no fit: the scan has\ntoo few scales")
        axes.set_xticks([])
        return []
    errors = reach(values, low, high)
    chosen = dimension["estimator"].values == dimension["recommended"].item()
    handles = []
    for marked, style in (
        (~chosen, {"color": "0.45", "mfc": "white"}),
        (chosen, {"color": COLOURS[1]}),
    ):
        of = fitted & marked
        if of.any():
            drawn = axes.errorbar(
                values[of], rows[of], xerr=errors[:, of], fmt="o", capsize=2, **style
            )
            none = bool(dimension["no_dimension"].item())
            if marked is not chosen:
                drawn.set_label("other estimators, 95 %")
            elif none:
                drawn.set_label("preferred estimator, 95 %: no dimension")
            else:
                drawn.set_label(rf"recommended $\Delta_g$ {_recommended_words(dimension)}")
            handles.append(drawn)
    handles += _impossible(axes)
    known = float(dimension["known_dimension"])
    if np.isfinite(known):
        line = axes.axvline(known, color=COLOURS[2], ls="--", lw=0.8)
        line.set_label(rf"known $\Delta_g$ {known:.3g}")
        handles.append(line)
    axes.grid(axis="x", color="0.9", lw=0.5)
    return handles


def _impossible(axes):
    """Shade what no surface has for a dimension, where the axis reaches it; entry of a legend."""
    low, high = axes.get_xlim()
    ends = [(low, min(high, 2)), (max(low, 3), high)]
    shaded = [
        axes.axvspan(*pair, color="0.88", lw=0, zorder=0) for pair in ends if pair[0] < pair[1]
    ]
    axes.set_xlim(low, high)
    for one in shaded[:1]:
        one.set_label("no dimension of a surface")
    return shaded[:1]


def _recommended_words(dimension):
    """The recommended value with its interval."""
    return Estimate.read(dimension, "recommended_dimension", scale=DIMENSION).text()


def _table(dimension):
    """Estimates of Delta_g, one row each."""
    return pd.DataFrame(
        {
            "face": "lower",
            "estimator": dimension["estimator"].values,
            **{
                of: dimension[of].values
                for name in ("dimension", "hurst_x", "hurst_y")
                for of in names_of(name)
            },
            "fit_min_mm": dimension["fit_min"].values,
            "fit_max_mm": dimension["fit_max"].values,
            "points": dimension["n"].values,
            "recommended": dimension["estimator"].values == dimension["recommended"].item(),
            "known_dimension": dimension["known_dimension"].item(),
        }
    )


def _size_words(specimen, sides):
    """Size and spacing of the scan; one number for the spacing where both agree."""
    name, size = length_unit(max(sides))
    spacings = {f"{specimen.attrs[f'spacing_{axis}']:.4g}" for axis in "xy"}
    return (
        f"{sides[1] / size:.4g} × {sides[0] / size:.4g} {name}, "
        f"spacing {' and '.join(sorted(spacings))} mm"
    )


def _caption(specimen, faces, dimension):
    absent = 1 - float(specimen["valid"].mean())
    holes = f", {percent(absent)} not measured" if absent else ""
    what = "levelled face" if len(faces) == 1 else "levelled faces"
    return f"{opening('Fig. 2')} Relief of the {what}{holes}. {_words(dimension)}"


def _words(dimension):
    """The recommended Delta_g, beside the known one and those of the other estimators."""
    table = dimension_table(dimension)
    if not table["n"]:
        return "No dimension could be fitted: the scan has too few scales."
    reason = dimension["no_dimension"].item()
    if reason:
        return f"No dimension is recommended: {reason}."
    estimator = str(dimension["recommended"].item())
    return (
        f"Delta_g is {_recommended_words(dimension)} by {estimator.replace('_', ' ')}"
        f"{_known_words(dimension)}; {table['n']} estimators give "
        f"{table['lowest']:.2f} to {table['highest']:.2f}."
    )


def _fit_words(dimension):
    """Entries of a legend: the range that gives the recommended Delta_g, roll-off, both axes."""
    words = []
    if dimension_table(dimension)["n"] and not dimension["no_dimension"].item():
        one = dimension.sel(estimator=str(dimension["recommended"].item()))
        ends = f"{float(one['fit_min']):.3g} to {float(one['fit_max']):.3g} mm"
        words.append(f"recommended: {one['length_kind'].item()}s {ends}")
    roll_off = float(dimension["roll_off"])
    if np.isfinite(roll_off):
        words.append(f"roll-off of the face at {roll_off:.3g} mm")
    return [*words, *_axes_words(dimension)]


def _known_words(dimension):
    """The known value of a synthetic surface, and whether the interval holds it."""
    known, low, high = (
        float(dimension[f"{key}_dimension{end}"])
        for key, end in (("known", ""), ("recommended", "_low"), ("recommended", "_high"))
    )
    if not np.isfinite(known):
        return ""
    return f"; known {known:.3g}, {'inside' if low <= known <= high else 'OUTSIDE'} the interval"


def _axes_words(dimension):
    """Entry of a legend: whether profiles along x and y have the same Hurst exponent, if known."""
    along = [dimension[f"hurst_{axis}"].values for axis in "xy"]
    both = np.isfinite(along).all(axis=0)
    if not both.any():
        return []
    apart = (dimension["hurst_x_low"] > dimension["hurst_y_high"]) | (
        dimension["hurst_y_low"] > dimension["hurst_x_high"]
    )
    separated = int(apart.values[both].sum())
    return [f"Hurst exponent: $x$, $y$ differ by\n{separated} of {both.sum()} estimators"]
