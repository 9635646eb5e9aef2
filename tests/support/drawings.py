"""The contract of every figure: axes with units, a short caption, and a table of the atlas."""

import re

import numpy as np
import xarray as xr
from drawn_arrays import column_of, digits, lost, points_of, unkept
from markup import MARKUP
from matplotlib.text import Text

from fractalcontact.figures.draw import drawer_of
from fractalcontact.figures.kit.drawing import print_style
from fractalcontact.study.figure_list import all_figures

#: A caption has fewer words than this; signs such as = and % are none.
MAX_WORDS = 70
#: Words that only those who wrote the program know.
PRIVATE = (
    r"\b(nan|told|made|share|met|arm|jobs?|seeds?|held against|scenes?|bound of the solver|"
    r"atlas group|lanes?|twiddle|hats?|knots?)\b"
)
#: Words of a verdict on the paper, which only the tables of statements have.
VERDICT = (
    r"\b(holds|not hold|holds? in part|ill-posed|established|refut\w+|support\w*|confirm\w*|"
    r"contradict\w*|disprov\w+|proves?|proven|(as|unlike|against) (in )?(the paper|eqs?\.))(?!\w)"
)
#: Figures of experiments that decide about eq. 6 themselves: they count their own verdicts.
DECIDED = {"size_effect": {"refuted", "supported"}}
#: Columns of a figure that no stage has, nor their values: what tells its rows apart, places along
#: a profile, faces moved onto each other, and sums of two columns.
OWN = {
    "overview": {"lower_in_contact_mm", "upper_in_contact_mm", "upper_as_given_mm"},
    "fig02_relief": {"face"},
    "quality": {"node", "place_mm", "height_mm"},
    "fig03_composite": {"upper_before_mm", "upper_after_mm"},
    "fig04_05_closure": {"spacing_mm"},
    "fig10_scaling": {"specimen_b_mm"},
    "fig13_size_effect": {"specimen_b_mm"},
    "size_test": {"determined", "determined_N"},
    "size_prediction": {f"ratio{end}{of}" for end in ("", "_low", "_high") for of in ("", "_mm")},
    "errors": {"at_load", "error", "relative_error", "source"},
    "three_exponents": {"exponent", "value", "value_half_width"},
    "contact_geometry": {"known"},
    "size_strength": {"drawn"},
    "plateau": {"specimen", "direction_or_seed", "roll_off_mm", "uncorrelated_mm"},
}
#: Columns with the name of a variable that hold a mean or a mark of it: tests of their own.
CHANGED = {
    "fig02_relief": {"recommended"},
    "plateau": {
        *("rigid_dilatancy_mm", "composite_rms_mm"),
        *("composite_rms_expected_mm", "dilatancy_over_rms"),
    },
}


#: Atlases whose figures several tests look at, each with its drawings.
_KEPT = []


def keep_drawings(atlas):
    """The atlas, each of whose figures :func:`draw` draws once: tests do not change them."""
    _KEPT.append((atlas, {}))
    return atlas


def draw(atlas, figure, subject):
    """A figure by its name, of a specimen or of a list of them."""
    drawings = next((drawings for kept, drawings in _KEPT if kept is atlas), {})
    key = figure, str(subject)
    if key not in drawings:
        with print_style():
            drawings[key] = drawer_of(figure)(atlas, subject)
    return drawings[key]


def changed(atlas, group, change=None, **values):
    """The atlas with a group put through a function of its dataset, or with values everywhere."""
    other = atlas.copy()
    data = other[group].to_dataset()
    for name, value in values.items():
        data[name] = xr.full_like(data[name], value)
    other[group] = xr.DataTree(change(data) if change else data)
    return other


def words_of(caption):
    """Words of a caption, without its signs."""
    return [word for word in caption.split() if re.search(r"\w", word)]


def breaches(drawing, atlas, figure, subject):
    """What a drawing breaks of the contract, in words."""
    return [
        *_of_axes(drawing.figure),
        *_of_caption(drawing.caption, DECIDED.get(figure, set())),
        *_of_table(drawing.data, atlas, figure, subject),
        *lost(drawing.data, atlas, figure, subject),
        *unkept(points_of(drawing.figure), drawing.data, figure),
    ]


def _of_axes(figure):
    panels = [axes for axes in figure.axes if axes.axison and axes.get_label() != "<colorbar>"]
    for axes in panels:
        labels = [label for label in (axes.get_xlabel(), axes.get_ylabel()) if label]
        bare = [label for label in labels if not re.search(r"\(.+\)$", label)]
        if bare or not labels:
            yield f"{axes.get_title(loc='left')[:30]}: no unit in {bare}"
    if not panels:
        yield "no axes"


def _of_caption(caption, verdicts):
    if len(words_of(caption)) >= MAX_WORDS:
        yield f"{len(words_of(caption))} words: {caption}"
    if not caption.startswith(("After ", "Supplementary figure")):
        yield f"begins otherwise: {caption}"
    if found := re.search(f"{PRIVATE}|\\binf\\b|WARNING|  |{MARKUP.pattern}", caption):
        yield f"{found[0]!r} in {caption}"
    if said := {found[0] for found in re.finditer(VERDICT, caption)} - verdicts:
        yield f"{said}: the verdict of a figure, in {caption}"


def _of_table(table, atlas, figure, subject):
    if not 0 < len(table) <= 20_000:
        yield f"{len(table)} rows"
    if MARKUP.search(table.to_csv()):
        yield "markup in the table"
    stages = of_stages(atlas, figure, subject)
    for column in set(table) - {"panel"} - OWN.get(figure, set()):
        if column not in stages:
            yield f"{column}: no variable of a stage that is needed"
            continue
        found = strangers(table, column, stages[column])
        if found and column not in CHANGED.get(figure, ()):
            yield f"{column}: {found[:3]} not in the atlas"


def of_stages(atlas, figure, subject):
    """Variables of the stages that a figure needs, by the names of columns that they have."""
    found = {}
    for stage in all_figures()[figure].needs:
        groups = atlas[stage].children if stage in atlas.children else {}
        for name, group in groups.items():
            if name == subject or not isinstance(subject, str) or stage == "contact_maps":
                data = group.to_dataset()
                for variable in (*data.variables, *data.dims):
                    found.setdefault(column_of(data, variable), []).append((data, variable))
    return found


def strangers(table, column, variables):
    """Values of a column that no variable of its name has at their places.

    The places are those dimensions of the variable that all rows of a panel have as columns.
    """
    found = []
    wholes = [_with_places(data, variable) for data, variable in variables]
    columns = {column}.union(*(names for names, _ in wholes)) & {*table}
    for _, rows in table.groupby("panel") if "panel" in table else [("", table)]:
        rows = rows[rows[column].notna()]
        known = np.zeros(len(rows), bool)
        held = {key: digits(rows[key]) for key in columns if rows[key].notna().all()}
        for names, values in wholes if len(rows) else ():
            keys = [key for key in names if key in held]
            stored = {*zip(*(values[names[key]] for key in keys), values["its value"], strict=True)}
            places = zip(*(held[key] for key in (*keys, column)), strict=True)
            known |= [one in stored for one in places]
        found += rows[column][~known].tolist()
    return found


def _with_places(data, variable):
    """Dimensions of a variable by their columns, and digits of its values and their places."""
    names = {column_of(data, dim): dim for dim in data[variable].dims}
    values = xr.DataArray(data[variable]).reset_coords(drop=True).expand_dims("whole")
    values = values.to_series().rename("its value").reset_index()
    return names, {name: digits(values[name]) for name in (*names.values(), "its value")}


def content_of(drawing):
    """Lines, pictures and words of a drawing, its table and its caption."""
    figure = drawing.figure
    lines = [line.get_xydata().tobytes() for axes in figure.axes for line in axes.lines]
    images = [image.get_array().tobytes() for axes in figure.axes for image in axes.images]
    words = [text.get_text() for text in figure.findobj(Text)]
    return lines, images, words, drawing.data.to_csv(), drawing.caption
