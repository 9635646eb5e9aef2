"""Rigid and elastic dilatancy, and the contact domains along the way (Figs. 6 and 7)."""

from matplotlib.figure import Figure
from xarray import DataTree

from ...core.limits import LEVEL_CHANGE, RESOLVED_NODES
from ...core.subject import Subject
from ...core.text import compact, force_label, percent
from ...core.verdicts import FALLING, LEVEL, RISING
from ...core.window import window_sides
from .. import kit
from ._rigid_dilatancy import direction_style, draw_rigid

TITLE = "Figs. 6 and 7: rigid and elastic dilatancy, and contact domains along the curve"
SUBJECT = "joint"
NEEDS = (
    "specimens",
    "joints",
    "dilatancy",
    "closure",
    "contact",
    "statements",
    "measured",
)
ORDER = 100
JOINT_STUDY = True

#: Height of the curves and their legend, inches.
_TOP = 3.7
#: Letters of the contact domains, and their number side by side.
LETTERS, COLUMNS = "ABCDEF", 3
#: Further variables of the states in the table.
_OF_STATES = (
    *("separation", "bulk_settlement", "nodes"),
    *("area_share", "area_corrected_share", "area_corrected_resolved"),
)
#: Statements on the dilatancy of rock and of concrete.
_PLATEAUS = ("dilatancy_flattens", "dilatancy_flattens_in_two")


def draw(atlas: DataTree, name: str) -> kit.Drawing:
    """Dilatancy curves, which are its data with the contact areas, and domains at six offsets."""
    subject = Subject.of(atlas, name)
    plateaus, elastic = subject["joints"], subject.curves("dilatancy")["elastic_dilatancy"]
    curves = subject.curves().assign(elastic_dilatancy=elastic.drop_vars("contact_direction"))
    points = kit.spread(curves.sizes["offset"], len(LETTERS))

    height = 2.5 * -(-len(points) // COLUMNS)
    figure = Figure(figsize=(kit.WIDTH, _TOP + height))
    top, bottom = figure.subfigures(2, 1, height_ratios=[_TOP, height])  # type: ignore[misc]  # an array
    left, right = top.subplots(1, 2)
    a = kit.Panel(left, "a", "rigid dilatancy")
    b = kit.Panel(right, "b", f"elastic dilatancy, {kit.place(subject.direction)}")
    key = draw_rigid(a, subject["dilatancy"], plateaus)
    _draw_elastic(b, subject, curves, points)
    kit.draw_tests(b, subject, "dilatancy")
    kit.legends_below(top, key, b.entries)
    _draw_domains(bottom, subject, curves, points)
    title = f"(c) contact domains at $F$ = {force_label(subject.reported.force)}"
    bottom.suptitle(f"{title}, small nodes enlarged", x=0.01, ha="left", fontsize=8)
    kit.headline(figure, subject.label)
    trends = dict(zip(plateaus["direction"].values, plateaus["plateau_trend"].values, strict=True))
    end = float(plateaus["rigid_offset"][-1])
    undecided = next(filter(None, plateaus["plateau_undecided"].values.tolist()), "")
    words = {
        "end": end,
        "undecided": undecided,
        "tests": kit.test_words(subject, "dilatancy"),
        "force": subject.reported.force,
        "fitted": sum(map(bool, trends.values())),
        "level": list(trends.values()).count(LEVEL),
        "others": {
            trend: [kit.TOWARDS[one] for one, trend_found in trends.items() if trend_found == trend]
            for trend in (RISING, FALLING)
        },
        "within": percent(LEVEL_CHANGE),
        "plateaus": list(filter(None, (kit.claim(atlas, name, said) for said in _PLATEAUS))),
        "fall": kit.claim(atlas, name, "area_falls"),
    }
    return kit.Drawing(figure, kit.table_of(a, b), kit.caption(__name__, **words))


def _draw_elastic(panel, subject, curves, points):
    """Elastic dilatancy under the reported loads, below the rigid one; letters of the domains."""
    axes, rigid = panel.axes, subject.along("dilatancy")
    number = list(subject["dilatancy"]["direction"].values).index(subject.direction)
    style = direction_style(number) | {"label": "rigid, $F$ = 0, as in (a)"}
    axes.plot(rigid["rigid_offset"], rigid["rigid_dilatancy"], **style)
    shown = curves.isel(normal_force=subject.reported.quoted)
    labels = [f"$F$ = {force_label(force)}" for force in shown["normal_force"].values]
    style = {"hue": "normal_force", "labels": labels, "first": 4, "filled": "resolved", "ls": "-"}
    panel.curves(shown, "offset", "elastic_dilatancy", keep=_OF_STATES, **style)
    if not shown["resolved"].all():
        kit.hollow_entry(axes, f"hollow: under {RESOLVED_NODES} nodes")
    opened = curves["elastic_dilatancy"].isel(normal_force=subject.reported.reference)
    for letter, (v, delta) in zip(LETTERS, opened[points].to_series().items(), strict=False):
        below = {"textcoords": "offset points", "ha": "center", "path_effects": kit.HALO}
        axes.annotate(letter, (v, delta), (0, -11), **below)
    kit.offset_axis(axes, curves["offset"].values)
    if axes.get_xscale() == "log":
        ends = curves["offset"].values[[0, -1]]
        axes.set_xlim(ends[0] / 1.3, ends[1] * 1.3)
    axes.margins(y=0.2)  # room for a letter below the lowest point
    axes.set_ylabel(r"dilatancy $\delta$ (mm)")


def _draw_domains(figure, subject, curves, points):
    """Contact domains of the reference load at some offsets."""
    load = {"normal_force": subject.reported.reference}
    fields = subject.along("contact")[f"in_contact_{subject.reported.resolution}"]
    panels = figure.subplots(-(-len(points) // COLUMNS), COLUMNS, squeeze=False).ravel()
    for letter, axes, i in zip(LETTERS, panels, points, strict=False):
        domain = fields.isel({**load, "offset": i}).values
        kit.draw_domain(axes, domain, window_sides(subject["specimens"]))
        state = curves.isel({**load, "offset": i})
        area = kit.area_label(state)
        axes.set_title(f"{letter}: $v$ = {compact(state['offset'])} mm, $A_r/A_0$ = {area}")
    for axes in panels[len(points) :]:
        axes.remove()
