"""The page "What carries the size effect", written from the numbers of an atlas.

python -m fractalcontact.commands.size_effect_page results/size_effect/atlas.nc docs/size_effect.md
"""

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import xarray as xr

from ..core.atomic import atomic_write
from ..core.errors import InputError
from ..study.atlas import read_atlas

#: Arms that vary the size, in words.
ARMS = {
    "S1": "roll-off fixed",
    "S2": "roll-off in proportion to the side",
    "S3": "no roll-off",
    "W": "windows of surfaces without a roll-off",
}


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
    of_strength = [] if strength is None else _strength(strength)
    return "\n".join(
        [
            *_head(test, study),
            *_size(test),
            *_resolution(test),
            *_geometry(test),
            *of_strength,
            *_questions(test),
        ]
    )


def _head(test: xr.Dataset, study: str) -> list[str]:
    surfaces = test.sizes["surface"]
    return [
        "# What carries the size effect",
        "",
        "Written by `python -m fractalcontact.commands.size_effect_page` from the atlas of the "
        "study "
        f"`{study}` (`make STUDY=config/{study}.yaml`): {surfaces} surfaces. Every number below "
        "is of "
        "that run; intervals are of 99 % and over surfaces.",
        "",
        "Eq. 6 of the paper has one exponent, 2 - Δσ, for three things: how the contact area "
        "falls with "
        "finer resolution, how sparse the contact domain is, and how the nominal pressure at "
        "one σ\\* "
        "falls with the side. Here each is varied alone, on synthetic surfaces whose spectrum "
        "has one "
        f"prefactor, a shortest wave of {test.attrs['cut_off']} nodes and a roll-off that is "
        "set by "
        "itself.",
        "",
    ]


def _size(test: xr.Dataset) -> list[str]:
    """The arms of sizes: alpha, prediction, verdict."""
    lines = [
        "## Size",
        "",
        "α = d ln(A_r/A_0) / d ln b at one nominal pressure, sides of "
        f"{test.attrs['smallest_side']} "
        "nodes and more, corrected area. `theory` is the same of Persson's area, from the rms "
        "slopes "
        "alone.",
        "",
        "| arm | H | p/(E\\* h'_rms) | α | theory | eq. 6 by A_r(s) | eq. 6 by boxes | verdict |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for arm in test["arm"].values:
        for hurst in test["hurst"].values:
            for load in test["reduced_pressure"].values:
                one = test.sel(arm=arm, hurst=hurst, reduced_pressure=load)
                flat = ", no size effect" if bool(one["no_size_effect"]) else ""
                cells = [
                    f"{arm}: {ARMS[str(arm)]}",
                    f"{hurst:g}",
                    f"{load:g}",
                    _with_error(one, "alpha"),
                    f"{float(one['theory_alpha']):+.3f}",
                    _with_error(one, "area_delta", less=2),
                    _with_error(one, "box_delta", less=2),
                    f"{one['verdict'].item()}{flat}",
                ]
                lines.append("| " + " | ".join(cells) + " |")
    rows = [
        f"{arm}, H = {hurst:g}: {test['overall'].sel(arm=arm, hurst=hurst).item()}"
        for arm in test["arm"].values
        for hurst in test["hurst"].values
    ]
    return [*lines, "", "Over all loads: " + "; ".join(rows) + ".", ""]


def _with_error(one: xr.Dataset, name: str, less: float = 0.0) -> str:
    value, error = float(one[name]), float(one[f"{name}_error"])
    return f"{value - less:+.3f} ± {error:.3f}" if np.isfinite(error) else "not known"


def _resolution(test: xr.Dataset) -> list[str]:
    lines = [
        "## Resolution",
        "",
        "Δσ by A_r(s), the short cut-off varied on one surface, and what the rms slope alone gives "
        "(Persson's theory):",
        "",
        "| H | p/(E\\* h'_rms) | by A_r(s) | from h'_rms | 1 + H |",
        "|---|---|---|---|---|",
    ]
    for hurst in test["hurst"].values:
        for load in test["reduced_pressure"].values:
            one = test.sel(hurst=hurst, reduced_pressure=load)
            lines.append(
                f"| {hurst:g} | {load:g} | {_with_error(one, 'area_delta')} | "
                f"{float(one['theory_delta']):.3f} | {1 + hurst:g} |"
            )
    departure = float(np.nanmax(abs(test["area_delta"] - test["theory_delta"])))
    return [
        *lines,
        "",
        f"The two differ by at most {departure:.3f}: the exponent of A_r(s) is the surface's, "
        "by its "
        "rms slope, and says nothing of the contact domain.",
        "",
    ]


def _geometry(test: xr.Dataset) -> list[str]:
    lines = [
        "## Geometry",
        "",
        "Correlation dimension of the contact domain between cut-off and roll-off, and of the "
        "bearing-area cut of as many nodes; random nodes have 2:",
        "",
        "| H | p/(E\\* h'_rms) | contact | bearing-area cut | boxes |",
        "|---|---|---|---|---|",
    ]
    for hurst in test["hurst"].values:
        for load in test["reduced_pressure"].values:
            one = test.sel(hurst=hurst, reduced_pressure=load)
            cells = (_with_error(one, name) for name in ("band_delta", "cut_delta", "box_delta"))
            lines.append(f"| {hurst:g} | {load:g} | " + " | ".join(cells) + " |")
    return [*lines, ""]


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
    nodes = test["nodes"].isel(surface=(test["of_size"] >= test.attrs["smallest_side"]).values)
    raw = (test["area_share"] / test["corrected_share"]).median("surface")
    return [
        "## Questions that a reader will have",
        "",
        "- **Edges.** The window lies alone on a half-space, and its rim carries more than its "
        "middle. "
        "In the central half, over Persson's area at the pressure found there, the exponent "
        "differs "
        f"from α by {float(central.median()):.3f} in the median and at most "
        f"{float(central.max()):.3f}.",
        "- **Window and mean plane.** Every surface is cut from one of twice its side, and its "
        "mean "
        "plane is taken off once.",
        "- **Prefactor or rms.** The prefactor is the same for all: a larger surface continues a "
        "smaller one. Scaled to one rms height, larger ones would be smoother at every wavelength.",
        "- **Decimation or low-pass.** The short cut-off is a low-pass on one grid; decimated "
        "surfaces "
        "alias and are others.",
        f"- **Correction of the area.** Raw over corrected, in the median of all surfaces: "
        f"{', '.join(f'{float(v):.3f}' for v in raw)} over the loads; a constant factor is in no "
        "exponent.",
        f"- **Few contacts.** The sparsest state has {int(nodes.min())} nodes.",
        "- **Loads.** p/(E\\* h'_rms) = "
        f"{', '.join(f'{float(p):g}' for p in test['reduced_pressure'])}, that is A_r/A_0 of "
        f"{float(test['corrected_share'].min()):.2g} to "
        f"{float(test['corrected_share'].max()):.2g}.",
        f"- **Error.** The largest standard error of α is {float(errors.max()):.3f}, the median "
        f"{float(errors.median()):.3f}.",
        "",
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
