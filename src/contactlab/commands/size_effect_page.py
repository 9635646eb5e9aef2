"""The page on the size effect, written from the numbers of an atlas.

python -m contactlab.commands.size_effect_page results/size_effect/atlas.nc docs/size_effect.md
"""

import argparse
import itertools
import sys
import textwrap
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
import xarray as xr

from fractalcontact.core.atomic import atomic_write
from fractalcontact.core.errors import InputError, said_in_one_line
from fractalcontact.study.atlas import read_atlas

from ..experiments.size_tasks import ARMS


def page(test: xr.Dataset, study: str, strength: xr.Dataset | None = None) -> str:
    """Text of the page, in Markdown.

    Parameters
    ----------
    test : xr.Dataset
        Group ``size_effect/surfaces`` of an atlas.
    study : str
        Name of the study, from which the command follows.
    strength : xr.Dataset, optional
        Group ``size_strength/surfaces``, where the atlas has it.
    """
    parts = (_head(test), _origin(test, study), _size(test), _stiffness(test), _resolution(test))
    of_strength = [] if strength is None else _strength(strength)
    rest = (_geometry(test), _constructions(test), of_strength, _questions(test), _surfaces(test))
    return "\n".join(line for part in (*parts, *rest) for line in part)


def _prose(text: str) -> list[str]:
    """A paragraph, wrapped, and the line that ends it."""
    return [*textwrap.wrap(" ".join(text.split()), 132, break_on_hyphens=False), ""]


def _table(head: str, rows: Iterable[Sequence[str]]) -> list[str]:
    """A table; columns of its head are parted by bars."""
    columns = head.count("|") + 1
    lines = ["| " + " | ".join(row) + " |" for row in rows]
    return [f"| {head} |", "|" + "---|" * columns, *lines, ""]


def _loads(test: xr.Dataset) -> str:
    """Loads as the heads of columns."""
    return " | ".join(f"{load:g}" for load in test["reduced_pressure"].values)


def _over_loads(one: xr.Dataset, *names: str, **less: float) -> list[str]:
    """A cell for each load: the value of each name with its error."""
    cells = [one.isel(reduced_pressure=i) for i in range(one.sizes["reduced_pressure"])]
    return ["; ".join(_with_error(cell, name, **less) for name in names) for cell in cells]


#: The picture of the page: that of the small part of the experiment in config/paper.yaml.
_PICTURE = (
    "![Exponents of the contact area over the resolution, of the contact domain by boxes, and of "
    "the area over the side, over load for H = 0.5 and 0.8, with null models](three_exponents.png)"
)


def _head(test: xr.Dataset) -> list[str]:
    """The answer, and the exponents of one load that it rests on."""
    verdicts = test["overall"].values
    counts = ", ".join(
        f"{verdict} in {n} of {verdicts.size}"
        for verdict, n in zip(*_counted(verdicts), strict=True)
    )
    flat = test["no_size_effect"].sel(arm="S1")
    answer = f"""
        **Answer.** The verdicts over the classes (arm and H) are: {counts}. With the roll-off fixed
        (arm S1) there is no size effect in {int(flat.sum())} of {flat.size} cases (H and load): the
        whole 99 % interval of the exponent lies within 0.02 of zero."""
    load = test["reduced_pressure"].values[min(1, test.sizes["reduced_pressure"] - 1)]
    text = f"""
        Eq. 6 has one exponent, Δσ - 2, for three things: how the contact area falls with finer
        resolution, how sparse the contact domain is, and how the nominal pressure at one σ\\* falls
        with the side. Varied alone, at p/(E\\* h'_rms) = {load:g}, they are three numbers:"""
    rows = []
    for hurst in test["hurst"].values:
        one = test.sel(hurst=hurst, reduced_pressure=load)
        rows.append(
            [
                f"{hurst:g}",
                _with_error(one, "area_delta", less=2),
                _with_error(one, "box_delta", less=2),
                _with_error(one.sel(arm="S1"), "alpha"),
            ]
        )
    head = "H | over resolution, A_r(s) | contact domain, boxes | over the side, measured (S1)"
    return [
        "# What carries the size effect",
        "",
        *_prose(answer),
        _PICTURE,
        "",
        *_prose(text.replace("\\\\", "\\")),
        *_table(head, rows),
    ]


def _origin(test: xr.Dataset, study: str) -> list[str]:
    text = f"""
        The surfaces are synthetic, lie against a plane, and have one spectral prefactor, a shortest
        wave of {test.attrs["cut_off"]} nodes and a roll-off that is varied on its own. This page
        was written by `python -m contactlab.commands.size_effect_page` from the atlas of
        {test.sizes["surface"]} surfaces, the picture from that of its small part in
        `config/paper.yaml`. Intervals over surfaces cover 99 %, those of the picture 95 %; ± is
        one standard error. Columns of the tables are loads p/(E\\* h'_rms)."""
    return [*_prose(text.replace("\\\\", "\\")), f"    make STUDY=config/{study}.yaml", ""]


def _counted(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return np.unique(values.astype(str), return_counts=True)


def _size(test: xr.Dataset) -> list[str]:
    """Exponents over the side, one row a class, and those of eq. 6."""
    rows = []
    for arm, hurst in _product(test, "arm", "hurst"):
        one = test.sel(arm=arm, hurst=hurst)
        flat = one["no_size_effect"].values
        cells = [
            f"{cell}{' *' if is_flat else ''}"
            for cell, is_flat in zip(_over_loads(one, "alpha"), flat, strict=True)
        ]
        rows.append([str(arm), f"{hurst:g}", *cells, str(one["overall"].item())])
    predicted = [
        [words, f"{hurst:g}", *_over_loads(test.sel(hurst=hurst), name, less=2)]
        for words, name in (("A_r(s)", "area_delta"), ("boxes", "box_delta"))
        for hurst in test["hurst"].values
    ]
    arms = "; ".join(f"{arm}: {ARMS[str(arm)]}" for arm in test["arm"].values)
    largest = float(abs(test["theory_alpha"]).max())
    text = f"""
        α = d ln(A_r/A_0) / d ln b at one nominal pressure, sides of {test.attrs["smallest_side"]}
        nodes and more, corrected area. Persson's theory, from the rms slopes alone, expects no
        more than {largest:.3f}. An asterisk marks no size effect: the 99 % interval lies within
        0.02 of zero. Arms: {arms}."""
    verdict = """
        Eq. 6 predicts α from Δσ, by either estimator. It is refuted for a class where α differs
        from both predictions beyond their joint interval; a prediction wider than 0.4 is
        inconclusive."""
    return [
        "## Size",
        "",
        *_prose(text),
        *_table(f"arm | H | {_loads(test)} | over all loads", rows),
        *_prose(verdict),
        *_table(f"eq. 6 by | H | {_loads(test)}", predicted),
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
    names = ("compliance_exponent", "separation_exponent")
    rows = [
        [str(arm), f"{hurst:g}", *_over_loads(test.sel(arm=arm, hurst=hurst), *names)]
        for arm, hurst in _product(test, "arm", "hurst")
    ]
    text = """
        Exponents over the side at one nominal pressure, of the compliance of the interface; of the
        mean gap. Without a roll-off they grow with the rms height, about as b^H: larger joints are
        more compliant because they are rougher, not because less of them touches."""
    loads = test["reduced_pressure"].values
    between = ", ".join(f"{a:g} to {b:g}" for a, b in itertools.pairwise(loads))
    law = f"""
        Stiffness of the largest surfaces as a power of the pressure (medians), between loads of
        {between}. Pastewka and others (2013) expect 1/(1 + H) where few hills carry, without a
        roll-off, and 1 above."""
    heads = [f"{hurst:g}" for hurst in test["hurst"].values]
    theory = ["1/(1 + H)", *(f"{1 / (1 + hurst):.2f}" for hurst in test["hurst"].values)]
    powers = [
        [str(arm), *(_powers(test, arm, hurst) for hurst in test["hurst"].values)]
        for arm in test["arm"].values
    ]
    return [
        "## Compliance and separation",
        "",
        *_prose(text),
        *_table(f"arm | H | {_loads(test)}", rows),
        *_prose(law),
        *_table(f"arm | H = {' | H = '.join(heads)}", [*powers, theory]),
    ]


def _powers(test: xr.Dataset, arm: str, hurst: float) -> str:
    """Powers of the stiffness over the pressure, between neighbouring loads."""
    here = (test["of_arm"] == arm) & (test["of_hurst"] == hurst)
    largest = here & (test["of_size"] == test["of_size"].where(here).max())
    compliance = test["compliance"].isel(surface=largest.values).values
    steps = np.diff(np.log(test["reduced_pressure"].values))
    slopes = -np.diff(np.log(np.where(compliance > 0, compliance, np.nan))) / steps
    known = [column[np.isfinite(column)] for column in slopes.T]
    return ", ".join(f"{np.median(one):.2f}" if one.size else "–" for one in known)


def _resolution(test: xr.Dataset) -> list[str]:
    rows = []
    for hurst in test["hurst"].values:
        one = test.sel(hurst=hurst)
        theory = [_number(value, ".3f") for value in one["theory_delta"]]
        cells = zip(_over_loads(one, "area_delta"), theory, strict=True)
        rows.append([f"{hurst:g}", *map("; ".join, cells), f"{1 + hurst:g}"])
    departure = float(np.nanmax(abs(test["area_delta"] - test["theory_delta"])))
    return [
        "## Resolution",
        "",
        *_prose(
            """Δσ by A_r(s), the short cut-off varied on one surface; then what the rms slope alone
            gives (Persson's theory):"""
        ),
        *_table(f"H | {_loads(test)} | 1 + H", rows),
        *_prose(
            f"""The two differ by at most {departure:.3f}: the exponent of A_r(s) follows from
            the rms slope of the surface and is no property of the contact domain."""
        ),
    ]


def _geometry(test: xr.Dataset) -> list[str]:
    names = {"contact": "band_delta", "bearing-area cut": "cut_delta"}
    rows = [
        [f"{hurst:g}", words, *_over_loads(test.sel(hurst=hurst), name)]
        for hurst in test["hurst"].values
        for words, name in names.items()
    ]
    return [
        "## Geometry",
        "",
        *_prose(
            """Correlation dimension of the contact domain between cut-off and roll-off, and of the
            bearing-area cut of as many nodes; random nodes have 2. Box-counting dimensions of the
            domain, minus 2, stand under Size. A dimension that grows with the load, as that of the
            cut does, is no property of the surface:"""
        ),
        *_table(f"H | set | {_loads(test)}", rows),
    ]


def _constructions(test: xr.Dataset) -> list[str]:
    """Arm G, where there is one."""
    if not test.sizes["construction"]:
        return []
    rows = [
        [
            str(name),
            f"{hurst:g}",
            *_over_loads(
                test.sel(construction=name, hurst=hurst), "geometry_delta", "geometry_cut"
            ),
        ]
        for name, hurst in _product(test, "construction", "hurst")
    ]
    return [
        *_prose(
            """The same for other constructions of known dimension (arm G): contact domain; cut:"""
        ),
        *_table(f"construction | H | {_loads(test)}", rows),
    ]


def _strength(test: xr.Dataset) -> list[str]:
    """Strength of sliding joints at equal v and at equal v/b, elastic and capped."""
    truncated = float(test["truncated_share"].mean())
    text = f"""
        Mated joints ({test.sizes["surface"]} surfaces, h'_rms {test.attrs["rms_slope"]:g}, roll-off
        {test.attrs["roll_off"]:g} nodes) slide over their copies, with sides of
        {test.attrs["smallest_side"]} nodes and more. The exponent over b is that of τ/σ₀ =
        tan(φ_b + i), φ_b = {test.attrs["basic_friction_angle"]:g}°, i = atan(Δδ/Δv) between
        successive displacements. No angle is truncated; {100 * truncated:.2g} % of them lie outside
        0° to {test.attrs["largest_friction_angle"]:g}°. At equal v all intervals are taken
        together. The columns at equal v/b hold three exponents: that of all joints, that of the
        largest joints alone at the same v, where size plays no part, and that of the
        height-difference function S(v). An asterisk marks exponents within {test.attrs["bound"]:g}
        of zero (no size effect), a question mark undetermined ones."""
    ends = test.isel(hurst=0, law=0, reduced_pressure=0)
    fractions = " | ".join(
        f"v/b = {float(low):.3g} to {float(high):.3g}"
        for low, high in zip(ends["fraction_low"], ends["fraction_high"], strict=True)
    )
    rows = [
        [f"{hurst:g}", str(law), f"{load:g}", *_strength_cells(one)]
        for hurst, law, load in _product(test, "hurst", "law", "reduced_pressure")
        for one in [test.sel(hurst=hurst, law=law, reduced_pressure=load)]
    ]
    classes = "; ".join(
        f"H = {hurst:g}, {law}: {test['overall'].sel(hurst=hurst, law=law).item()}"
        for hurst, law in _product(test, "hurst", "law")
    )
    others = "; ".join(_other_exponents(test, str(law)) for law in test["law"].values)
    rest = f"""
        Over all loads: {classes}. Contact area and separation at equal v, over all displacements:
        {others}. A window alone on a half-space carries more at its rim as it grows, which makes
        the mean separation rise a little with b; by eq. 6 the strength would fall."""
    head = f"H | contact | p/(E\\* h'_rms) | equal v | {fractions}"
    return ["## Strength", "", *_prose(text), *_table(head, rows), *_prose(rest)]


#: Signs of the verdicts on an exponent of the strength.
_SIGNS = {"no size effect": " *", "undetermined": " ?"}


def _strength_cells(one: xr.Dataset) -> list[str]:
    """Exponents of one class at one load: at equal v, then at equal v/b."""

    def marked(of_one: xr.Dataset, name: str) -> str:
        return _with_error(of_one, name) + _SIGNS.get(of_one[f"{name}_verdict"].item(), "")

    cells = [marked(one, "pooled_exponent")]
    for k in range(one.sizes["fraction"]):
        of_one = one.isel(fraction=k)
        predicted, theory = (
            float(of_one[name]) for name in ("predicted_exponent", "theory_exponent")
        )
        own = marked(of_one, "scaled_strength_exponent")
        cells.append(f"{own}; {predicted:+.3f}; {theory:+.3f}")
    return cells


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
            plane is removed once; each window of arm W has its own mean plane removed.""",
        "Prefactor or rms": """The prefactor is the same for all: a larger surface continues a
            smaller one. Scaled to one rms height, larger ones would be smoother at every
            wavelength.""",
        "Decimation or low-pass": """The short cut-off is a low-pass on one grid; decimated surfaces
            alias, and are different surfaces.""",
        "Correction of the area": f"""Ratio of raw to corrected area, median of all surfaces:
            {", ".join(f"{float(v):.3f}" for v in raw.median("surface"))} over the loads; a constant
            factor changes no exponent.""",
        "Few contacts": f"""The sparsest state in an exponent has {float(nodes.min()):.0f} nodes in
            contact (in arm W, the mean over windows).""",
        "Loads": f"""p/(E\\* h'_rms) = {loads}, that is A_r/A_0 of
            {float(shares.min()):.2g} to {float(shares.max()):.2g}.""",
        "Errors": f"""Largest residual of the contact conditions:
            {float(test["residual"].max()):.1g} of the closure. Largest standard error of α:
            {float(errors.max()):.3f}, of arm S1 {float(errors.sel(arm="S1").max()):.3f}.""",
    }
    lines = [line for name, text in points.items() for line in _prose(f"- **{name}.** {text}")[:-1]]
    return ["## Questions that a reader will have", "", *lines, ""]


def _surfaces(test: xr.Dataset) -> list[str]:
    """Number of surfaces of each class in the run."""
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


@said_in_one_line
def main(arguments: Sequence[str] | None = None) -> int:
    """Read the atlas, write the page; exit code 1 if there is no such atlas, else 0."""
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
    return 0


if __name__ == "__main__":
    sys.exit(main())
