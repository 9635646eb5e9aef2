"""Fig. 8: the contact domain at coarser and coarser resolution, and its real mean pressure."""

from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.subject import Subject
from ...core.text import compact, force_label
from ...core.window import window_sides
from .. import kit

TITLE = "Fig. 8: contact domains of the pre-fractals under one load, and their mean pressure"
SUBJECT = "specimen"
NEEDS = ("specimens", "contact", "closure", "scaling", "area", "elastic_model", "statements")
ORDER = 130

#: Number of maps side by side, and largest enlargement of their nodes.
_COLUMNS, _WIDEST = 4, 3
_LETTERS = "abcdefghijklmnop"


def draw(atlas: DataTree, name: str) -> kit.Drawing:
    """Contact domains at all resolutions, with A_r and sigma_n = F / A_r."""
    subject = Subject.of(atlas, name)
    load, force = subject.reported.reference, subject.reported.force
    states = _states(subject)
    model, n = subject.state("elastic_model"), states.sizes["resolution"]
    sides = window_sides(subject["specimens"])
    rows, columns = -(-n // _COLUMNS), min(n, _COLUMNS)
    height = rows * (kit.WIDTH / _COLUMNS * sides[0] / sides[1] + 0.75)
    figure = Figure(figsize=(kit.WIDTH, height + 2.3))
    top, bottom = figure.subfigures(2, 1, height_ratios=[height, 2.0])  # type: ignore[misc]  # an array
    maps = top.subplots(rows, columns, squeeze=False, sharey=True).ravel()
    domains = [kit.contact_domain(subject, k, load) for k in states["resolution"].values]
    points = 72 * 0.85 * kit.WIDTH / columns / max(domains[0].shape)
    times = kit.enlargement(domains, points, _WIDEST)
    for i, domain in enumerate(domains):
        kit.draw_domain(maps[i], domain, sides, ticks=4, times=times)
        kit.letter(maps[i], _LETTERS[i], _area_words(states.isel(resolution=i)))
        maps[i].label_outer()
    for axes in maps[n:]:
        axes.remove()
    by_area, by_boxes = kit.estimates_of(subject.states("scaling"))
    law = rf"$A_r \sim s^{{2-\Delta_\sigma}}$: {by_area.entry(load)}"
    title = rf"$\sigma_n = F/A_r$; {law}; rms slope of the surface {compact(states['rms_slope'])}"
    panel = kit.Panel(bottom.subplots(), _LETTERS[n], title)
    _draw_pressures(panel, states, model)
    wide = "black: real contact area $A_r$; small nodes enlarged alike in all maps"
    where = kit.place(subject.direction, subject.offset)
    kit.headline(figure, subject.label, where, f"$F$ = {force_label(force)}", below=wide)
    words = {key: str(model[key].item()) for key in ("verdict", "reason")}
    words |= {"falls": kit.claim(atlas, name, "area_is_lacunar")}
    for key, one in (("area", by_area), ("box", by_boxes)):
        words |= {key: one.number(load), f"by_{key}": one.eq6_exponent(load)}
    return kit.Drawing(figure, kit.table_of(panel), kit.caption(__name__, force=force, **words))


def _states(subject):
    """States at all resolutions under the reference load, corrected areas where they are known."""
    closure, scaling = (
        kit.prefractals(subject, stage).isel(normal_force=subject.reported.reference)
        for stage in ("closure", "scaling")
    )
    enough = closure["area_corrected_resolved"]
    corrected = {of: closure[of].where(enough) for of in ("area_corrected", "area_corrected_share")}
    kept = closure[["nodes", "area", "area_share", "area_corrected_resolved"]].assign(corrected)
    kept = kept.assign(scaling[["spacing", "sigma_n", "sigma_n_raw"]].data_vars)
    return kept.assign(rms_slope=subject.states("area")["rms_slope"])


def _area_words(state):
    """Area and pressure of a panel: corrected, or raw where too few nodes touch."""
    corrected = bool(state["area_corrected_resolved"])
    area, pressure = ("area_corrected", "sigma_n") if corrected else ("area", "sigma_n_raw")
    return (
        f"$s$ = {compact(state['spacing'])} mm\n$A_r$ = {compact(state[area])} mm$^2$\n"
        f"$A_r/A_0$ = {kit.area_label(state)}\n$\\sigma_n$ = {compact(state[pressure])} MPa"
    )


def _draw_pressures(panel, states, model):
    axes, style = panel.axes, {"color": kit.COLOURS[0], "marker": "o"}
    corrected = states.isel(resolution=states["area_corrected_resolved"].values)
    if corrected.sizes["resolution"]:
        label = r"$A_r$ corrected for its edge"
        axes.plot(corrected["spacing"], corrected["sigma_n"], **style, label=label)
    raw = {"mfc": "none", "ls": ":", "lw": 0.8, "label": "$A_r$ raw"}
    kept = [name for name in states if name not in ("spacing", "sigma_n_raw")]
    panel.curve(states, "spacing", "sigma_n_raw", keep=kept, **style, **raw)
    ends = [float(model[f"strength_{end}"]) for end in ("low", "high")]
    label = f"{model['criterion'].item()}:\n{' to '.join(dict.fromkeys(map(compact, ends)))} MPa"
    axes.axhspan(
        *ends, fc=to_rgba(kit.COLOURS[2], 0.2), ec=kit.COLOURS[2], ls="--", lw=1, label=label
    )
    axes.set_yscale("log")
    kit.spacing_axis(axes, states["spacing"])
    axes.set_ylabel(f"{kit.REAL_PRESSURE} (MPa)")
    axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), borderaxespad=0)
