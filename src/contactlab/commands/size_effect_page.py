"""The page "What carries the size effect", written from the numbers of an atlas.

python -m contactlab.commands.size_effect_page results/size_effect/atlas.nc docs/size_effect.md
"""

import argparse
import itertools
import textwrap
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
import xarray as xr

from fractalcontact.core.atomic import atomic_write
from fractalcontact.core.errors import InputError
from fractalcontact.study.atlas import read_atlas

from ..experiments.size_tasks import ARMS


def page(test: xr.Dataset, study: str, strength: xr.Dataset | None = None) -> str:
    """The page in Markdown.

    Parameters
    ----------
    test : xr.Dataset
        Group ``size_effect/surfaces`` of an atlas.
    study : str
        Name of the study, from which the command follows.
    strength : xr.Dataset, optional
        Group ``size_strength/surfaces``, where the atlas has it.
    """
    parts = (_head(test, study), _size(test), _stiffness(test), _resolution(test))
    of_strength = [] if strength is None else _strength(strength)
    rest = (_geometry(test), _constructions(test), of_strength, _questions(test), _surfaces(test))
    return "\n".join(line for part in (*parts, *rest) for line in part)


def _prose(text: str) -> list[str]:
    """A paragraph, wrapped, and the line that ends it."""
    return [*textwrap.wrap(" ".join(text.split()), 110, break_on_hyphens=False), ""]


def _table(head: str, rows: Iterable[Sequence[str]]) -> list[str]:
    """A table; columns of its head are parted by bars."""
    columns = head.count("|") + 1
    lines = ["| " + " | ".join(row) + " |" for row in rows]
    return [f"| {head} |", "|" + "---|" * columns, *lines, ""]


def _head(test: xr.Dataset, study: str) -> list[str]:
    verdicts = test["overall"].values
    counts = ", ".join(f"{n} {verdict}" for verdict, n in zip(*_counted(verdicts), strict=True))
    flat = test["no_size_effect"].sel(arm="S1")
    text = f"""
        Eq. 6 of the paper has one exponent, 2 - Δσ, for three things: how the contact area falls
        with finer resolution, how sparse the contact domain is, and how the nominal pressure at one
        σ\\* falls with the side. Here each is varied alone, on synthetic surfaces against a plane
        whose spectrum has one prefactor, a shortest wave of {test.attrs["cut_off"]} nodes and a
        roll-off that is set by itself."""
    answer = f"""
        **Answer.** Of the {verdicts.size} classes (arm and H): {counts}. With the roll-off fixed
        (arm S1) there is no size effect at all at {int(flat.sum())} of {flat.size} loads: the whole
        99 % interval of the exponent lies within 0.02 of zero."""
    origin = f"""
        Written by `python -m contactlab.commands.size_effect_page` from the atlas of this
        study: {test.sizes["surface"]} surfaces. Every number below is of that run; intervals are of
        99 % and over surfaces."""
    return [
        "# What carries the size effect",
        "",
        *_prose(text.replace("\\\\", "\\")),
        *_prose(answer),
        *_prose(origin),
        f"    make STUDY=config/{study}.yaml",
        "",
    ]


def _counted(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return np.unique(values.astype(str), return_counts=True)


def _size(test: xr.Dataset) -> list[str]:
    """The arms of sizes: alpha, prediction, verdict."""
    rows = []
    for arm, hurst, load in _product(test, "arm", "hurst", "reduced_pressure"):
        one = test.sel(arm=arm, hurst=hurst, reduced_pressure=load)
        flat = ", no size effect" if bool(one["no_size_effect"]) else ""
        rows.append(
            [
                f"{arm}: {ARMS[str(arm)]}",
                f"{hurst:g}",
                f"{load:g}",
                _with_error(one, "alpha"),
                _number(one["theory_alpha"], "+.3f"),
                _with_error(one, "area_delta", less=2),
                _with_error(one, "box_delta", less=2),
                f"{one['verdict'].item()}{flat}",
            ]
        )
    classes = [
        f"{arm}, H = {hurst:g}: {test['overall'].sel(arm=arm, hurst=hurst).item()}"
        for arm, hurst in _product(test, "arm", "hurst")
    ]
    text = f"""
        α = d ln(A_r/A_0) / d ln b at one nominal pressure, sides of {test.attrs["smallest_side"]}
        nodes and more, corrected area, ± one standard error. *theory* is the same of Persson's
        area, from the rms slopes alone. Eq. 6 is refuted for a class where α differs from both
        predictions beyond their joint interval; a prediction wider than 0.4 decides nothing."""
    return [
        "## Size",
        "",
        *_prose(text),
        *_table(
            "arm | H | p/(E\\* h'_rms) | α | theory | eq. 6 by A_r(s) | eq. 6 by boxes | verdict",
            rows,
        ),
        *_prose("Over all loads: " + "; ".join(classes) + "."),
    ]


def _product(test: xr.Dataset, *names: str) -> Iterable[tuple]:
    return itertools.product(*(test[name].values for name in names))


def _with_error(one: xr.Dataset, name: str, less: float = 0.0) -> str:
    value, error = float(one[name]), float(one[f"{name}_error"])
    return f"{value - less:+.3f} ± {error:.3f}" if np.isfinite(error) else "not known"


def _number(value: xr.DataArray, form: str) -> str:
    return format(float(value), form) if np.isfinite(value) else "not known"


def _stiffness(test: xr.Dataset) -> list[str]:
    """Compliance and separation over the side, and stiffness over the pressure."""
    rows = [
        [
            f"{arm}",
            f"{hurst:g}",
            f"{load:g}",
            _with_error(
                test.sel(arm=arm, hurst=hurst, reduced_pressure=load), "compliance_exponent"
            ),
            _with_error(
                test.sel(arm=arm, hurst=hurst, reduced_pressure=load), "separation_exponent"
            ),
        ]
        for arm, hurst, load in _product(test, "arm", "hurst", "reduced_pressure")
    ]
    text = """
        Compliance of the interface and mean gap at one nominal pressure, as powers of the side.
        Without a roll-off they grow with the rms height, about as b^H: larger joints are more
        compliant because they are rougher, not because less of them touches."""
    powers = []
    loads = test["reduced_pressure"].values
    for arm, hurst in _product(test, "arm", "hurst"):
        here = (test["of_arm"] == arm) & (test["of_hurst"] == hurst)
        largest = here & (test["of_size"] == test["of_size"].where(here).max())
        compliance = test["compliance"].isel(surface=largest.values).values
        slopes = -np.diff(np.log(np.where(compliance > 0, compliance, np.nan))) / np.diff(
            np.log(loads)
        )
        known = [column[np.isfinite(column)] for column in slopes.T]
        cells = [f"{np.median(one):.2f}" if one.size else "not known" for one in known]
        powers.append([str(arm), f"{hurst:g}", *cells, f"{1 / (1 + hurst):.2f}"])
    between = " | ".join(f"{a:g} to {b:g}" for a, b in itertools.pairwise(loads))
    law = """
        Stiffness of the largest surfaces as a power of the pressure, between loads (medians).
        Pastewka and others (2013) expect 1/(1 + H) where few hills carry, without a roll-off, and 1
        above."""
    return [
        "## Compliance and separation",
        "",
        *_prose(text),
        *_table("arm | H | p/(E\\* h'_rms) | compliance | mean gap", rows),
        *_prose(law),
        *_table(f"arm | H | {between} | 1/(1 + H)", powers),
    ]


def _resolution(test: xr.Dataset) -> list[str]:
    rows = []
    for hurst, load in _product(test, "hurst", "reduced_pressure"):
        one = test.sel(hurst=hurst, reduced_pressure=load)
        rows.append(
            [
                f"{hurst:g}",
                f"{load:g}",
                _with_error(one, "area_delta"),
                _number(one["theory_delta"], ".3f"),
                f"{1 + hurst:g}",
            ]
        )
    departure = float(np.nanmax(abs(test["area_delta"] - test["theory_delta"])))
    return [
        "## Resolution",
        "",
        *_prose(
            """Δσ by A_r(s), the short cut-off varied on one surface, and what the rms slope alone
            gives (Persson's theory):"""
        ),
        *_table("H | p/(E\\* h'_rms) | by A_r(s) | from h'_rms | 1 + H", rows),
        *_prose(
            f"""The two differ by at most {departure:.3f}: the exponent of A_r(s) is the surface's,
            by its rms slope, and says nothing of the contact domain."""
        ),
    ]


def _geometry(test: xr.Dataset) -> list[str]:
    rows = []
    for hurst, load in _product(test, "hurst", "reduced_pressure"):
        one = test.sel(hurst=hurst, reduced_pressure=load)
        cells = (_with_error(one, name) for name in ("band_delta", "cut_delta", "box_delta"))
        rows.append([f"{hurst:g}", f"{load:g}", *cells])
    return [
        "## Geometry",
        "",
        *_prose(
            """Correlation dimension of the contact domain between cut-off and roll-off, and of the
            bearing-area cut of as many nodes; random nodes have 2. A dimension that goes with the
            load, as that of the cut does, is no property of the surface:"""
        ),
        *_table("H | p/(E\\* h'_rms) | contact | bearing-area cut | boxes", rows),
    ]


def _constructions(test: xr.Dataset) -> list[str]:
    """Arm G, where there is one."""
    if not test.sizes["construction"]:
        return []
    rows = []
    for name, hurst, load in _product(test, "construction", "hurst", "reduced_pressure"):
        one = test.sel(construction=name, hurst=hurst, reduced_pressure=load)
        cells = (_with_error(one, variable) for variable in ("geometry_delta", "geometry_cut"))
        rows.append([str(name), f"{hurst:g}", f"{load:g}", *cells])
    return [
        *_prose("The same of other constructions of known dimension (arm G):"),
        *_table("construction | H | p/(E\\* h'_rms) | contact | bearing-area cut", rows),
    ]


def _strength(test: xr.Dataset) -> list[str]:
    """Strength of sliding joints at equal v and at equal v/b, elastic and capped."""
    share = float(test["truncated_share"].mean())
    lines = [
        "## Strength",
        "",
        f"Mated joints ({test.sizes['surface']} surfaces, h'_rms {test.attrs['rms_slope']:g}, "
        f"roll-off {test.attrs['roll_off']:g} nodes) that slide over their copies, sides of "
        f"{test.attrs['smallest_side']} nodes and more: exponent over b of τ/σ₀ = tan(φ_b + i), "
        f"φ_b = {test.attrs['basic_friction_angle']:g}°, i = atan(Δδ/Δv) between successive "
        "displacements, not truncated. A bound of "
        f"{test.attrs['largest_friction_angle']:g}° (and of 0°) would meet {100 * share:.2g} % of "
        "the angles. At equal v all intervals are taken together; at equal v/b `by v alone` is "
        "what the largest joints have at the same v, `S(v)` what the height-difference function "
        "alone makes of it.",
        "",
        "| H | contact | p/(E\\* h'_rms) | held equal | exponent | by v alone | S(v) | verdict |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for hurst in test["hurst"].values:
        for law in test["law"].values:
            for load in test["reduced_pressure"].values:
                one = test.sel(hurst=hurst, law=law, reduced_pressure=load)
                lines += _strength_rows(one, f"| {hurst:g} | {law} | {load:g} |")
    rows = [
        f"H = {hurst:g}, {law}: {test['overall'].sel(hurst=hurst, law=law).item()}"
        for hurst in test["hurst"].values
        for law in test["law"].values
    ]
    return [
        *lines,
        "",
        f"An exponent within {test.attrs['bound']:g} of zero is no size effect. Over all loads: "
        + "; ".join(rows)
        + ". Contact area and separation at equal v, over all displacements: "
        + "; ".join(_other_exponents(test, str(law)) for law in test["law"].values)
        + ". A window alone on a half-space carries more at its rim as it grows, which makes the "
        "mean separation rise a little with b; eq. 6 wants the strength to fall.",
        "",
    ]


def _other_exponents(test: xr.Dataset, law: str) -> str:
    """Range of the exponents of contact area and separation under one law."""
    texts = []
    for name, words in (("area_exponent", "A_r/A_0"), ("separation_exponent", "separation")):
        values, errors = (test[f"{name}{end}"].sel(law=law) for end in ("", "_error"))
        verdicts = test[f"{name}_verdict"].sel(law=law).values
        effects = int((verdicts == "size effect").sum())
        low, middle, high = (float(one()) for one in (values.min, values.median, values.max))
        texts.append(
            f"{words} {low:+.3f} to {high:+.3f} (median {middle:+.3f}, standard error up to "
            f"{float(errors.max()):.3f}; a size effect in {effects} of {verdicts.size})"
        )
    return f"{law}, " + ", ".join(texts)


def _strength_rows(one: xr.Dataset, start: str) -> list[str]:
    """Rows of one class at one load."""
    verdict = one["pooled_exponent_verdict"].item()
    rows = [f"{start} v | {_with_error(one, 'pooled_exponent')} | 0 | 0 | {verdict} |"]
    for k in range(one.sizes["fraction"]):
        of_one = one.isel(fraction=k)
        cells = [
            f"v/b = {float(of_one['fraction_low']):.4g} to {float(of_one['fraction_high']):.4g}",
            _with_error(of_one, "scaled_strength_exponent"),
            _with_error(of_one, "predicted_exponent"),
            f"{float(of_one['theory_exponent']):+.3f}",
            of_one["scaled_strength_exponent_verdict"].item(),
        ]
        rows.append(f"{start} " + " | ".join(cells) + " |")
    return rows


def _questions(test: xr.Dataset) -> list[str]:
    central = abs(test["central_alpha"] - test["alpha"])
    errors = test["alpha_error"]
    spectra = test["of_construction"] == ""
    sides = (test["of_size"] >= test.attrs["smallest_side"]) & spectra
    nodes = test["nodes"].isel(surface=sides.values)
    raw = (test["area_share"] / test["corrected_share"]).isel(surface=spectra.values)
    shares = test["corrected_share"].isel(surface=spectra.values)
    loads = ", ".join(f"{float(p):g}" for p in test["reduced_pressure"])
    points = {
        "Edges": f"""The window lies alone on a half-space; its rim carries more than its middle. In
            the central half, over Persson's area at the pressure found there, the exponent
            differs from α by {float(central.median()):.3f} in the median and at most
            {float(central.max()):.3f}.""",
        "Window and mean plane": """Every surface is cut from one of twice its side, and its mean
            plane is taken off once; windows of arm W lose their own.""",
        "Prefactor or rms": """The prefactor is the same for all: a larger surface continues a
            smaller one. Scaled to one rms height, larger ones would be smoother at every
            wavelength.""",
        "Decimation or low-pass": """The short cut-off is a low-pass on one grid; decimated surfaces
            alias and are others.""",
        "Correction of the area": f"""Raw over corrected, in the median of all surfaces:
            {", ".join(f"{float(v):.3f}" for v in raw.median("surface"))} over the loads; a constant
            factor is in no exponent.""",
        "Few contacts": f"""The sparsest state in an exponent has {float(nodes.min()):.0f} nodes (of
            arm W in the mean over its windows).""",
        "Loads": f"""p/(E\\* h'_rms) = {loads}, that is A_r/A_0 of
            {float(shares.min()):.2g} to {float(shares.max()):.2g}.""",
        "Solver": f"""Largest residual of the contact conditions:
            {float(test["residual"].max()):.1g} of the closure.""",
        "Error": f"""The largest standard error of α is {float(errors.max()):.3f}, that of arm S1
            {float(errors.sel(arm="S1").max()):.3f}.""",
    }
    lines = [line for name, text in points.items() for line in _prose(f"- **{name}.** {text}")[:-1]]
    return ["## Questions that a reader will have", "", *lines, ""]


def _surfaces(test: xr.Dataset) -> list[str]:
    """How many surfaces of each class the run has."""
    rows = []
    for arm in np.unique(test["of_arm"].values):
        one = test.isel(surface=(test["of_arm"] == arm).values)
        sizes = np.unique(one["of_size"].values)
        cells = []
        for size in sizes:
            part = one.isel(surface=(one["of_size"] == size).values)
            fields = ("of_hurst", "of_cut_off", "of_construction")
            kinds = zip(*(part[name].values for name in fields), strict=True)
            cells.append(f"{part.sizes['surface'] // len(set(kinds))} of {size}")
        rows.append([f"{arm}: {ARMS[str(arm)]}", ", ".join(cells)])
    return [
        "## Surfaces",
        "",
        *_prose("Surfaces of each class (H, cut-off, construction) by their nodes per side:"),
        *_table("arm | surfaces", rows),
    ]


def main(arguments: Sequence[str] | None = None) -> None:
    """Read the atlas, write the page."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("atlas", type=Path)
    parser.add_argument("page", type=Path)
    stated = parser.parse_args(arguments)
    atlas = read_atlas(stated.atlas, without=("contact",))
    if "size_effect" not in atlas.children:
        raise InputError(f"{stated.atlas}: no stage size_effect; run config/size_effect.yaml first")
    strength = (
        atlas["size_strength/surfaces"].to_dataset() if "size_strength" in atlas.children else None
    )
    test = atlas["size_effect/surfaces"].to_dataset()
    text = page(test, stated.atlas.parent.name, strength)
    with atomic_write(stated.page) as path:
        path.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
