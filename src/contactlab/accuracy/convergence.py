"""Convergence of the discrete contact to exact solutions."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from fractalcontact.core.datasets import labelled_dataset, titled
from fractalcontact.core.fitting import fit_line
from fractalcontact.core.labels import cf_attrs
from roughcontact.contact.solve import solve_contact
from roughcontact.elastic.halfspace import HalfSpace

from .richardson import richardson

# Width of the window over that of the contact: the surface outside never touches.
WINDOW = 1.2
#: Contact radius, mm, on E* = 1 MPa: the relative errors depend on neither.
RADIUS = 0.1
# The paraboloid of Hertz has this radius of curvature, mm.
CURVATURE = 1.0
# Closure of the punch, and depth of the surface around it, mm.
PUNCH_CLOSURE, PUNCH_DEPTH = 0.01, 1.0

#: Quantities compared with the exact solution, and the order in s of their errors that Richardson's
#: extrapolation assumes. The number of nodes on a disc scatters with s^1.5 about its area.
PROBLEM_QUANTITIES: dict[str, dict[str, float]] = {
    "hertz": {"force": 2, "radius": 1, "peak_pressure": 2},
    "punch": {"force": 1, "radius": 1.5},
}
_WORDS = {"force": "force", "radius": "contact radius", "peak_pressure": "peak pressure"}
#: Tolerances of the solves, far below the errors of the grid.
_RTOL, _TRIAL_RTOL = 1e-6, 1e-7


@titled("error against spacing where the solution is known, and Richardson's extrapolation")
def convergence(problem: str, recipe: Mapping[str, Any]) -> xr.Dataset:
    """Error against spacing for "hertz" or "punch", or the "richardson" trials, by a recipe."""
    if problem == "richardson":
        return richardson_trials(recipe["trials"], recipe["trial_cells"], seed=recipe["seed"])
    return error_over_spacing(problem, recipe["cells"], recipe["placements"])


def error_over_spacing(
    problem: str, cells_per_radius: Sequence[int], placements: int
) -> xr.Dataset:
    """Error of a contact with a known solution against the number of cells across its radius.

    The relative errors depend on no size or modulus: a paraboloid of radius of curvature 1 mm, or
    a flat circular punch, is pressed until the contact radius is 0.1 mm, on E* = 1 MPa. The
    discrete contact domain is a staircase whose area jumps with the position of the centre among
    the nodes, so each error is the root mean square over ``placements`` x ``placements`` positions
    within a cell.

    Parameters
    ----------
    problem : {"hertz", "punch"}
    cells_per_radius : sequence of int
        Cells across the contact radius, a / s.
    placements : int
        Positions of the centre in each direction.

    Returns
    -------
    Dataset
        On ``cells_per_radius``: ``force_error``, ``radius_error`` (of the disc as large as the
        contact domain) and, of Hertz's, ``peak_pressure_error``, relative to the exact value; at
        the edge of a punch the pressure is infinite. For each also the order with which it falls
        with s and its interval: ``force_order``, ``force_order_low``, ``force_order_high``.

    Notes
    -----
    Hertz: F = 4/3 E* R^(1/2) w^(3/2), a^2 = R w, p0 = 2 E* a / (pi R). Punch: F = 2 E* a w
    (Boussinesq).
    """
    within_cell = (np.arange(placements) + 0.5) / placements - 0.5
    centres = [(y, x) for y in within_cell for x in within_cell]
    errors = [
        np.sqrt(np.mean([np.square(_ERRORS[problem](n, c, _RTOL)) for c in centres], axis=0))
        for n in cells_per_radius
    ]
    cells = np.asarray(cells_per_radius)
    attributes = cf_attrs("1", "cells across the contact radius, a/s")
    result = xr.Dataset(coords={"cells_per_radius": ("cells_per_radius", cells, attributes)})
    for name, error in zip(PROBLEM_QUANTITIES[problem], np.transpose(errors), strict=True):
        order = fit_line(np.log(1 / cells), np.log(error)).slope
        words = f"relative error of the {_WORDS[name]}, rms over positions"
        result[f"{name}_error"] = ("cells_per_radius", error, cf_attrs("1", words))
        words = f"order of the error of the {_WORDS[name]} in s"
        result.update(order.variables(f"{name}_order", (), "1", words))
    return result


def _hertz_errors(cells_per_radius, centre, rtol):
    """Relative errors of force, radius and peak pressure with the apex off the node by ``centre``.

    The closure starts at the first touch of a node, that of the theory at the first touch of the
    apex.
    """
    y, x, spacing = _grid(cells_per_radius, centre)
    height = -(y**2 + x**2) / (2 * CURVATURE)
    closure = RADIUS**2 / CURVATURE
    space = HalfSpace(height.shape, (spacing, spacing), 1.0)
    state = solve_contact(height, space, closure=closure + height.max(), rtol=rtol)
    return (
        state.force / (4 / 3 * np.sqrt(CURVATURE) * closure**1.5) - 1,
        np.sqrt(state.area / np.pi) / RADIUS - 1,
        state.pressure.max() / (2 * RADIUS / (np.pi * CURVATURE)) - 1,
    )


def _punch_errors(cells_per_radius, centre, rtol):
    """Relative errors of force and radius with the axis off the node by ``centre``, in cells."""
    y, x, spacing = _grid(cells_per_radius, centre)
    height = np.where(np.hypot(y, x) < RADIUS, 0.0, -PUNCH_DEPTH)
    space = HalfSpace(height.shape, (spacing, spacing), 1.0)
    state = solve_contact(height, space, closure=PUNCH_CLOSURE, rtol=rtol)
    return (
        state.force / (2 * RADIUS * PUNCH_CLOSURE) - 1,
        np.sqrt(state.area / np.pi) / RADIUS - 1,
    )


_ERRORS = {"hertz": _hertz_errors, "punch": _punch_errors}


def _grid(cells_per_radius, centre):
    """Coordinates (y, x) of the nodes from the centre of the contact, and their spacing, mm."""
    spacing = RADIUS / cells_per_radius
    half = int(np.ceil(WINDOW * cells_per_radius))
    y, x = (spacing * (np.arange(-half, half + 1) - c) for c in centre)
    return y[:, np.newaxis], x[np.newaxis, :], spacing


#: Variables of `richardson_trials`: dimensions, unit, long name.
_TRIALS: dict[str, tuple[str | tuple[str, ...], str, str]] = {
    "error": (("quantity", "case"), "1", "error of Richardson's value, relative"),
    "bar": (("quantity", "case"), "1", "its own error bar, relative"),
    "finest": (("quantity", "case"), "1", "error at the finest spacing, relative"),
    "within": ("quantity", "1", "cases within their own bar"),
    "order": ("quantity", "1", "order in s assumed"),
}


def richardson_trials(cases: int, cells: tuple[float, float], *, seed: int) -> xr.Dataset:
    """Trials of Richardson's extrapolation: values within their own error bar of the exact one.

    Every case has its own place of the centre among the nodes and its own, not whole, number of
    cells across the radius, between the two ``cells`` at the finest spacing, and is solved at the
    spacings s, 2 s and 4 s.

    Returns
    -------
    Dataset
        On (quantity, case): ``error`` of Richardson's value and its ``bar``, and ``finest``, the
        error at s, all relative to the exact value; on quantity ``within``, the cases whose error
        is no larger than the bar, and ``order``, assumed.
    """
    generator = np.random.default_rng(seed)
    ratios = generator.uniform(*cells, size=cases)
    centres = generator.uniform(-0.5, 0.5, size=(cases, 2))
    names, orders, rows = [], [], []
    for problem, quantities in PROBLEM_QUANTITIES.items():
        # The centre is a place, the same on every grid.
        errors = np.array(
            [
                [_ERRORS[problem](ratio / k, centre / k, _TRIAL_RTOL) for k in (1, 2, 4)]
                for ratio, centre in zip(ratios, centres, strict=True)
            ]
        )
        for i, (name, order) in enumerate(quantities.items()):
            names.append(f"{problem} {_WORDS[name]}")
            orders.append(order)
            limit = richardson(errors[:, :, i].T, order)
            rows.append((np.abs(limit.value), limit.error, np.abs(errors[:, 0, i])))
    error, bar, finest = np.swapaxes(rows, 0, 1)
    values = {
        "error": error,
        "bar": bar,
        "finest": finest,
        "within": np.count_nonzero(error <= bar, axis=1),
        "order": orders,
    }
    return labelled_dataset(
        _TRIALS,
        values,
        coords={
            "quantity": ("quantity", names, cf_attrs("1", "quantity extrapolated")),
            "cells": ("case", ratios, cf_attrs("1", "cells across the radius, finest spacing")),
        },
    )
