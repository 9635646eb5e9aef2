"""How far the contact solver is from exact results, and what its discretisation decides."""

import numpy as np
import xarray as xr

from .contact import solve_contact
from .fitting import fit_line
from .halfspace import RIGID_PLATE_SELF_TERMS, HalfSpace

# The window is this many times the Hertzian contact across: what lies outside never touches.
WINDOW = 1.2


def hertz_convergence(cells_per_radius=(5, 10, 20, 40), *, placements=4, rtol=1e-6):
    """Error of the Hertz contact against the number of cells across its radius.

    The relative errors depend on no size or modulus: a paraboloid of radius of curvature 1 mm is
    pressed until the contact radius is 0.1 mm, on E* = 1 MPa. The discrete contact domain is a
    staircase whose area jumps with the position of the centre among the nodes, so each error is
    the root mean square over ``placements`` x ``placements`` positions within a cell.

    Parameters
    ----------
    cells_per_radius : sequence of int
        Cells across the contact radius, a / s.
    placements : int
        Positions of the centre in each direction.
    rtol : float
        Tolerance of the solver.

    Returns
    -------
    Dataset
        On ``cells_per_radius``: ``force_error``, ``radius_error`` (of the disc as large as the
        contact domain) and ``peak_pressure_error``, each a share of the exact value. For each also
        the order with which it falls with s, and the interval of the order: ``force_order``,
        ``force_order_low``, ``force_order_high`` and so on.

    Notes
    -----
    F = 4/3 E* R^(1/2) w^(3/2), a^2 = R w, p0 = 2 E* a / (pi R).
    """
    within_cell = (np.arange(placements) + 0.5) / placements - 0.5
    centres = [(y, x) for y in within_cell for x in within_cell]
    errors = [
        np.sqrt(np.mean([np.square(_hertz_errors(n, c, rtol)) for c in centres], axis=0))
        for n in cells_per_radius
    ]
    cells = np.asarray(cells_per_radius)
    attributes = {"units": "1", "long_name": "cells across the contact radius, a/s"}
    result = xr.Dataset(coords={"cells_per_radius": ("cells_per_radius", cells, attributes)})
    names = {"force": "force", "radius": "contact radius", "peak_pressure": "peak pressure"}
    for (name, label), error in zip(names.items(), np.transpose(errors), strict=True):
        fit = fit_line(np.log(1 / cells), np.log(error))
        result[f"{name}_error"] = _labelled(
            error, f"relative error of the {label}, rms over positions", "cells_per_radius"
        )
        result[f"{name}_order"] = _labelled(fit.slope, f"order of the error of the {label} in s")
        for end in ("low", "high"):
            result[f"{name}_order_{end}"] = _labelled(
                getattr(fit, f"slope_{end}"), f"{end} end of the 95 % interval of the order"
            )
    return result


def _labelled(values, long_name, *dims, units="1"):
    return xr.Variable(dims, values, {"units": units, "long_name": long_name})


def _hertz_errors(cells_per_radius, centre, rtol):
    """Relative errors of force, radius and peak pressure with the apex off the node by ``centre``.

    Closure counts from the first touch of a node, the theory's from that of the apex.
    """
    modulus, curvature, radius = 1.0, 1.0, 0.1
    spacing = radius / cells_per_radius
    half = int(np.ceil(WINDOW * cells_per_radius))
    y, x = (spacing * (np.arange(-half, half + 1) - c) for c in centre)
    height = -(y[:, None] ** 2 + x[None, :] ** 2) / (2 * curvature)
    closure = radius**2 / curvature
    space = HalfSpace(height.shape, (spacing, spacing), modulus)
    state = solve_contact(height, space, closure=closure + height.max(), rtol=rtol)
    return (
        state.force / (4 / 3 * modulus * np.sqrt(curvature) * closure**1.5) - 1,
        np.sqrt(state.area / np.pi) / radius - 1,
        state.pressure.max() / (2 * modulus * radius / (np.pi * curvature)) - 1,
    )


def kernel_effect(composite, spacing, modulus, closure):
    """What the choice of the kernel decides: Love's, or a reading of the paper's rigid plate.

    Parameters
    ----------
    composite : (ny, nx) array_like
        Composite topography, mm.
    spacing : float
        Side of the square cells, mm.
    modulus : float
        E*, MPa.
    closure : float
        w from first touch, mm.

    Returns
    -------
    Dataset
        ``force`` (N), ``area`` (mm2) and ``stiffness`` (N/mm) on ``kernel``.
    """
    kernels = ["love", *RIGID_PLATE_SELF_TERMS]
    shape = np.shape(composite)
    states = [
        solve_contact(
            composite, HalfSpace(shape, (spacing, spacing), modulus, kernel=k), closure=closure
        )
        for k in kernels
    ]
    attributes = {"units": "1", "long_name": "influence of a loaded node"}
    result = xr.Dataset(coords={"kernel": ("kernel", kernels, attributes)})
    for name, units, label in (
        ("force", "N", "normal force"),
        ("area", "mm2", "area of the contact domain"),
        ("stiffness", "N/mm", "normal stiffness dF/dw"),
    ):
        values = [getattr(state, name) for state in states]
        result[name] = _labelled(values, label, "kernel", units=units)
    return result
