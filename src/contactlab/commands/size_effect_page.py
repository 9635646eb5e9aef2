"""The page on the size effect, written from the numbers of an atlas by ``size_effect.md.jinja``.

python -m contactlab.commands.size_effect_page results/size_effect/atlas.nc docs/size_effect.md
"""

import argparse
import itertools
import sys
import textwrap
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import xarray as xr
from jinja2 import Environment, StrictUndefined

from fractalcontact.core.atomic import atomic_write
from fractalcontact.core.errors import InputError, said_in_one_line
from fractalcontact.study.atlas import read_atlas

from ..experiments import size_decision
from ..experiments.size_tasks import ARMS

_TEMPLATE = Path(__file__).with_name("size_effect.md.jinja")
_WIDTH = 132
#: Signs of the verdicts on an exponent of the strength.
_SIGNS = {"no size effect": " *", "undetermined": " ?"}
#: Properties, other than seeds, by which surfaces of one arm and side differ.
_CLASS = ("hurst", "cut_off", "construction")


def page(test: xr.Dataset, study: str, strength: xr.Dataset | None = None) -> str:
    """Text of the page, in Markdown.

    From the groups ``size_effect/surfaces`` and, if the atlas has it, ``size_strength/surfaces``;
    the name of the study gives the command.
    """
    environment = Environment(trim_blocks=True, lstrip_blocks=True, undefined=StrictUndefined)
    environment.filters["prose"] = _prose
    environment.filters["number"] = _number
    spectra = (test["of_construction"] == "").values
    fitted = spectra & (test["of_size"] >= test.attrs["smallest_side"]).values
    text = environment.from_string(_TEMPLATE.read_text(encoding="utf-8")).render(
        test=test,
        of_spectra=test.isel(surface=spectra),
        fitted=test.isel(surface=fitted),
        study=study,
        strength=strength,
        ARMS=ARMS,
        rule=size_decision,
        product=itertools.product,
        cells=_cells,
        counted=_counted,
        with_error=_with_error,
        flagged=lambda test: [" *" if flat else "" for flat in test["no_size_effect"].values],
        powers=_powers,
        fractions=_fractions,
        strength_cells=_strength_cells,
        other_exponents=_other_exponents,
        surfaces=_surfaces,
    )
    return text.rstrip() + "\n"


def _prose(text: str) -> str:
    """A paragraph, wrapped."""
    return "\n".join(textwrap.wrap(" ".join(text.split()), _WIDTH, break_on_hyphens=False)) + "\n"


def _number(value: object, form: str) -> str:
    number = float(value)  # type: ignore[arg-type]
    return format(number, form) if np.isfinite(number) else "not known"


def _with_error(one: xr.Dataset, name: str, less: float = 0.0) -> str:
    value, error = float(one[name]), float(one[f"{name}_error"])
    return f"{value - less:+.3f} ± {error:.3f}" if np.isfinite(error) else "not known"


def _cells(
    one: xr.Dataset, *names: str, less: float = 0.0, beside: str = "", sign: Sequence[str] = ()
) -> str:
    """Cells for the loads: the value of each name with its error, a number, and a sign."""
    cells = []
    for i in range(one.sizes["reduced_pressure"]):
        cell = one.isel(reduced_pressure=i)
        texts = [_with_error(cell, name, less) for name in names]
        texts += [_number(cell[beside], ".3f")] if beside else []
        cells.append("; ".join(texts) + (sign[i] if sign else ""))
    return " | ".join(cells)


def _counted(verdicts: np.ndarray) -> list[str]:
    counts = zip(*np.unique(verdicts.astype(str), return_counts=True), strict=True)
    return [f"{verdict} in {n} of {verdicts.size}" for verdict, n in counts]


def _powers(test: xr.Dataset, arm: str, hurst: float) -> str:
    """Powers of the stiffness over the pressure, between neighbouring loads."""
    of_class = (test["of_arm"] == arm) & (test["of_hurst"] == hurst)
    largest = of_class & (test["of_size"] == test["of_size"].where(of_class).max())
    compliance = test["compliance"].isel(surface=largest.values).values
    steps = np.diff(np.log(test["reduced_pressure"].values))
    slopes = -np.diff(np.log(np.where(compliance > 0, compliance, np.nan))) / steps
    finite = [column[np.isfinite(column)] for column in slopes.T]
    return ", ".join(f"{np.median(column):.2f}" if column.size else "–" for column in finite)


def _fractions(test: xr.Dataset) -> str:
    """Heads of the columns at equal v/b."""
    ends = test.isel(hurst=0, law=0, reduced_pressure=0)
    pairs = zip(ends["fraction_low"], ends["fraction_high"], strict=True)
    return "".join(f" | v/b = {float(low):.3g} to {float(high):.3g}" for low, high in pairs)


def _strength_cells(of_class: xr.Dataset) -> str:
    """Exponents of one class at one load: at equal v, then at equal v/b."""

    def marked(test: xr.Dataset, name: str) -> str:
        return _with_error(test, name) + _SIGNS.get(test[f"{name}_verdict"].item(), "")

    cells = [marked(of_class, "pooled_exponent")]
    for k in range(of_class.sizes["fraction"]):
        of_fraction = of_class.isel(fraction=k)
        rest = (
            f"{float(of_fraction[f'{name}_exponent']):+.3f}" for name in ("predicted", "theory")
        )
        cells.append("; ".join((marked(of_fraction, "scaled_strength_exponent"), *rest)))
    return " | ".join(cells)


def _other_exponents(test: xr.Dataset) -> str:
    """Range of the exponents of contact area and separation under one law."""
    texts = []
    for name, words in (("area_exponent", "A_r/A_0"), ("separation_exponent", "separation")):
        values, errors, verdicts = (test[f"{name}{end}"] for end in ("", "_error", "_verdict"))
        effects = int((verdicts == "size effect").sum())
        low, middle, high = (float(take()) for take in (values.min, values.median, values.max))
        texts.append(
            f"{words} {low:+.3f} to {high:+.3f} (median {middle:+.3f}, standard error up to "
            f"{float(errors.max()):.3f}; a size effect in {effects} of {verdicts.size})"
        )
    return ", ".join(texts)


def _surfaces(test: xr.Dataset) -> dict[str, list[str]]:
    """Number of surfaces of each class in the run, by arm."""
    rows: dict[str, list[str]] = {}
    for arm, size in sorted({*zip(test["of_arm"].values, test["of_size"].values, strict=True)}):
        of_class = (test["of_arm"] == arm) & (test["of_size"] == size)
        part = test.isel(surface=of_class.values)
        kinds = {*zip(*(part[f"of_{key}"].values for key in _CLASS), strict=True)}
        rows.setdefault(str(arm), []).append(f"{part.sizes['surface'] // len(kinds)} of {size}")
    return rows


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
