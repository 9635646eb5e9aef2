"""Closure and dilatancy of the joint from its contact states (paper, sect. 5)."""

import numpy as np
import xarray as xr

from ..core.estimate import Estimate, names_of
from ..core.labels import cf_attrs
from ..core.limits import CORRECTED_NODES, RESOLVED_NODES
from ..core.settings import FREE
from ..states.settlement import bulk_settlement, interface_closure, interface_stiffness
from ..states.states import OFFSETS, STATE_VARIABLES, WITH_SCATTER, error_attrs
from .closure_laws import add_closure_laws, at_twice
from .conductance import add_conductance
from .load_curve import left_out_misses
from .seated_laws import add_seated_laws
from .separation import add_seated_closure, add_separation

#: Reasons why a solved state has no stiffness of the interface.
FLUSH_FACES = "the faces lie flush: there is no interface"
FULL_CONTACT = "contact is so full that joint and blocks together are no softer than the blocks"


def determined_closure(closing: xr.DataArray, flush: xr.DataArray) -> xr.DataArray:
    """Interface closure, mm, where it is determined: missing where contact is too full for one.

    Free faces in full contact are loaded like a rigid punch, which settles less than the uniform
    pressure of w_b does: by some 0.08 F/(E* b) for a square. Where the rough faces close by less
    than that, w - w_b is negative, which no closure is, and says nothing of the interface. Where
    faces are flush nothing closes, and that is known.
    """
    return closing.where((closing > 0) | flush)


def full_contact_warning(curves: xr.Dataset) -> str:
    """Warning where contact is so full that no interface is left to measure, "" if nowhere."""
    finest = curves.sel(resolution=curves["resolution"].min())
    solved = finest["solved"]
    full = int((solved & finest["interface_closure"].isnull()).sum())
    if not full:
        return ""
    return (
        f"contact is so full in {full} of {int(solved.sum())} states that the closure of the "
        "interface is smaller than the uncertainty of the settlement of the blocks: closure, "
        "dilatancy and stiffness of the interface are undetermined there"
    )


def closure_curves(
    states: xr.Dataset,
    window: tuple[float, float],
    e_star: float,
    fit_range: tuple[float, float] | None = None,
    *,
    openings: xr.DataArray | None = None,
    seating_pressure: float = 0.0,
) -> xr.Dataset:
    """Closure curves of the interface, and the laws that they follow.

    Parameters
    ----------
    states : xr.Dataset
        From :func:`states.states.combine`.
    window : (float, float)
        Sides (y, x) of the window, mm.
    e_star : float
        E*, MPa.
    fit_range : (float, float), optional
        Smallest and largest force of the fits, N; all by default.
    openings : xr.DataArray, optional
        From :func:`joint.openings.prefractal_openings`.
    seating_pressure : float, optional
        As of :func:`laws.separation.add_seated_closure`.

    Returns
    -------
    xr.Dataset
        ``bulk_settlement`` and ``nominal_pressure`` (normal_force); ``interface_closure``,
        ``separation``, ``seated_closure``, ``closure_from_common_seat``,
        ``closure_from_stated_seat``, ``interface_stiffness``, ``conductance``, ``area_share``,
        ``area_corrected_share``, each with an ``_error``,
        ``interface_compliance`` with the bounds that its error leaves,
        ``interface_stiffness_reason``, ``interface_stiffness_change``, ``resolved``,
        ``area_corrected_resolved``, ``closure_spacing_error`` and the numbers of the states over
        (direction, offset, resolution, load); ``seating_pressure``, ``prefractal_opening`` and the
        fits of :func:`laws.closure_laws.add_closure_laws` and
        :func:`laws.seated_laws.add_seated_laws` over (direction, offset, resolution);
        ``common_seating_pressure`` and why there is none over
        (direction, resolution); what :data:`states.states.OFFSETS` names over (direction,
        offset).
    """
    result = interface_curves(
        states, window, e_star, openings=openings, seating_pressure=seating_pressure
    )
    add_closure_laws(result, fit_range)
    add_seated_laws(result)
    return result


def interface_curves(
    states: xr.Dataset,
    window: tuple[float, float],
    e_star: float,
    *,
    openings: xr.DataArray | None = None,
    seating_pressure: float = 0.0,
) -> xr.Dataset:
    """Closure curves of :func:`closure_curves` without the laws that they follow."""
    result = interface_states(states, window, e_star)
    add_conductance(result, e_star)
    _add_errors(result, window[0] * window[1], e_star)
    add_separation(result, openings)
    add_seated_closure(result, seating_pressure)
    return result


def interface_states(states: xr.Dataset, window: tuple[float, float], e_star: float) -> xr.Dataset:
    """Closure, stiffness and contact of the interface alone, from each state by itself.

    Without the errors, separation and seats of :func:`interface_curves`.
    """
    result = states[[*STATE_VARIABLES, *OFFSETS]].copy()
    boundary = states.attrs.get("boundary", FREE)
    settlement = bulk_settlement(states["normal_force"].values, e_star, *window, boundary=boundary)
    _add_interface(result, settlement, window[0] * window[1])
    return result


def _add_interface(curves: xr.Dataset, settlement: np.ndarray, area: float) -> None:
    """Closure, stiffness and contact of the interface alone, into ``curves``."""
    order = curves["closure"].dims
    force = curves["normal_force"].values
    curves["bulk_settlement"] = ("normal_force", settlement, cf_attrs("mm", "bulk settlement w_b"))
    curves["nominal_pressure"] = (
        "normal_force",
        force / area,
        cf_attrs("MPa", "nominal pressure sigma_0 = F / A_0"),
    )
    # Variables are added together: each single assignment makes xarray check the whole dataset.
    added: dict[str, xr.DataArray | tuple] = {}
    flush = curves["composite_spread"] == 0
    closing = interface_closure(curves["closure"], curves["bulk_settlement"], flush)
    words = "interface closure w_int = w - w_b; missing where contact is too full"
    closing = determined_closure(closing, flush).transpose(*order)
    added["interface_closure"] = closing.assign_attrs(cf_attrs("mm", words))
    for name, words in (
        ("area", "real contact area A_r / A_0"),
        ("area_corrected", "real contact area A_r / A_0, corrected for the perimeter"),
    ):
        added[f"{name}_share"] = (curves[name] / area).assign_attrs(cf_attrs("1", words))
    for name, fewest, words in (
        ("resolved", RESOLVED_NODES, "{} nodes or more touch, else no fit takes the state"),
        (
            "area_corrected_resolved",
            CORRECTED_NODES,
            "{} nodes touch, enough for the correction",
        ),
    ):
        attrs = cf_attrs("1", words.format(fewest))
        added[name] = (curves["nodes"] >= fewest).assign_attrs(attrs)
    bulk = curves["bulk_settlement"] / curves["nominal_pressure"]
    stiffness = interface_stiffness(1 / (curves["stiffness"] / area), bulk).where(~flush)
    words = "tangent stiffness d sigma_0 / d w_int of the interface; missing if flush"
    stiffness = stiffness.transpose(*order).assign_attrs(cf_attrs("MPa/mm", words))
    added["interface_stiffness"] = stiffness
    reason = stiffness_reason(stiffness, curves["stiffness"], flush, curves["stiffness_reason"])
    # Bare values are stored, because labels made by xr.where have no units.
    why = reason.where(curves["solved"], "").transpose(*order).values
    added["interface_stiffness_reason"] = (order, why, reason.attrs)
    curves.update(added)
    del curves["stiffness_reason"]


def stiffness_reason(
    interface: xr.DataArray,
    total: xr.DataArray,
    flush: xr.DataArray | bool,
    no_total: xr.DataArray,
) -> xr.DataArray:
    """Reason why states have no stiffness of the interface; "" if they have one.

    ``total`` is the stiffness of interface and blocks together, ``no_total`` why that is missing.
    """
    why = xr.where(total.isnull(), no_total, FULL_CONTACT)
    why = xr.where(interface.notnull(), "", xr.where(flush, FLUSH_FACES, why))
    attrs = cf_attrs("1", "why there is no tangent stiffness of the interface")
    return why.transpose(*interface.dims).assign_attrs(attrs)


def _add_errors(curves: xr.Dataset, area: float, e_star: float) -> None:
    """Solver error bounds of derived quantities, and the error of the closures by the spacing."""
    fraction = (curves["interface_stiffness"] * area / curves["stiffness"]) ** 2
    stiffness = curves["stiffness_error"] / area * fraction
    errors = {
        "interface_closure": curves["closure_error"],
        "area_share": curves["area_error"] / area,
        "area_corrected_share": curves["area_corrected_error"] / area,
        "interface_stiffness": stiffness,
        "conductance": stiffness / e_star,
    }
    for name, error in errors.items():
        curves[f"{name}_error"] = error.transpose(*curves["closure"].dims)
        curves[f"{name}_error"].attrs = error_attrs(curves[name].attrs)
    scatter = (curves["stiffness_scatter"] / area * fraction).transpose(*curves["closure"].dims)
    words = "scatter of the interface stiffness over the cells that come to yield"
    curves["interface_stiffness_scatter"] = scatter.assign_attrs(cf_attrs("MPa/mm", words))
    for name in ("interface_stiffness", "conductance"):
        curves[f"{name}_error"].attrs = error_attrs(curves[name].attrs, WITH_SCATTER)
    curves["closure_spacing_error"] = _spacing_error(curves["closure"])
    _add_compliance(curves)
    curves["interface_stiffness_change"] = at_twice(curves["interface_stiffness"]).assign_attrs(
        cf_attrs("1", "interface stiffness at twice the spacing over that at this one, less one")
    )


def _add_compliance(curves: xr.Dataset) -> None:
    """Compliance of the interface with its solver error, stored in ``curves``.

    A stiffness whose error is as large as itself leaves the compliance unbounded.
    """
    name = "interface_stiffness"
    stiffness, error = curves[name].values, curves[f"{name}_error"].values
    softest = np.where(stiffness > error, stiffness - error, 0.0)
    softest = np.where(np.isnan(stiffness), np.nan, softest)
    with np.errstate(divide="ignore"):
        compliance = Estimate(stiffness, softest, stiffness + error).mapped(
            np.reciprocal, falling=True
        )
    for end, value in zip(names_of("interface_compliance"), compliance.ends, strict=True):
        words = "compliance d w_int / d sigma_0 of the interface"
        bound = "" if end == "interface_compliance" else f", {end[21:]} bound by the solver's error"
        curves[end] = (curves[name].dims, value, cf_attrs("mm/MPa", f"{words}{bound}"))


def _spacing_error(closure: xr.DataArray) -> xr.DataArray:
    """Change of the closure by halving the spacing, mm; NaN where it was not solved twice.

    It bounds the change by finer spacings where closures approach their limit like s or faster, as
    Hertz's does; elsewhere it says how far the last halving went.
    """
    fine = [k for k in closure["resolution"].values if 2 * k in closure["resolution"]]
    coarser = closure.sel(resolution=[2 * k for k in fine]).assign_coords(resolution=fine)
    error = abs(closure - coarser.reindex(resolution=closure["resolution"].values))
    error.attrs = cf_attrs("mm", "closure w, change from twice the spacing to this one")
    return error.transpose(*closure.dims)


def elastic_dilatancy(curves: xr.Dataset, joint: xr.Dataset) -> xr.Dataset:
    """delta(F, v) = delta_r(v) - w_int(F, v) at the scan's own resolution (eq. 4), mm.

    Over (contact_direction, offset, normal_force), with ``separation`` and ``left_out_error``, the
    error of interpolating the closure curve at this force where its own state is left out;
    ``offset_on_grid`` over (contact_direction, offset), and the rigid dilatancy of `joint`.

    delta_r and w_int both hang on the highest node, which cancels in their difference: with the
    separation of the mean planes u = delta_r - w and the bulk settlement w_b it is delta = u + w_b,
    but for flush faces, whose w_int is 0, and for a surface against a plane, whose u is counted
    from its mean plane.
    """
    result = joint[["rigid_dilatancy", "composite_rms"]].copy()
    finest = curves.sel(resolution=curves["resolution"].min(), drop=True)
    finest = finest.rename(direction="contact_direction")
    # The opening belongs to the cells whose contact was solved. That of `joint` is at the offsets
    # of the first direction; where cells are not square, the other directions differ.
    slides = finest["contact_direction"] != "none"
    opening = finest["prefractal_opening"].where(slides).fillna(finest["rigid_opening"])
    elastic = opening - finest["interface_closure"]
    result["elastic_dilatancy"] = elastic.transpose("contact_direction", "offset", "normal_force")
    result["elastic_dilatancy"].attrs = cf_attrs("mm", "elastic dilatancy delta = delta_r - w_int")
    for name in ("separation", "separation_error"):
        result[name] = finest[name].transpose(*result["elastic_dilatancy"].dims)
    # Flush faces close with their blocks alone: where those do not settle, nothing is interpolated.
    closes = (finest["bulk_settlement"] > 0) | (finest["interface_closure"] > 0)
    closure = finest["closure"].where(closes)
    misses = left_out_misses(finest["normal_force"].values, closure, finest["stiffness"])
    result["left_out_error"] = abs(misses).transpose(*result["elastic_dilatancy"].dims)
    result["left_out_error"].attrs = cf_attrs(
        "mm", "error of delta when interpolated from the states at the loads beside this one"
    )
    error = finest["closure_error"].transpose(*result["elastic_dilatancy"].dims)
    result["elastic_dilatancy_error"] = error
    result["elastic_dilatancy_error"].attrs = error_attrs(cf_attrs("mm", "elastic dilatancy"))
    result["offset_on_grid"] = finest["offset_on_grid"]
    return result
