"""The result page of a study: its numbers are the atlas's, its links lead to files, it is HTML."""

import inspect
import json
import re
import shutil
import zipfile
from dataclasses import replace
from html.parser import HTMLParser
from types import SimpleNamespace
from urllib.parse import unquote, urlsplit

import numpy as np
import pandas as pd
import pytest
import xarray as xr
import yaml
from code_blocks import run_code
from markup import MARKUP
from page_study import HOSTILE, STUDY, write_pages
from spreadsheets import FORMULA, formulas_in

from fractalcontact.core.claims import claims_of
from fractalcontact.core.estimate import Estimate
from fractalcontact.core.subject import Subject
from fractalcontact.core.text import short, with_unit
from fractalcontact.core.verdicts import TOO_WIDE
from fractalcontact.figures.draw import drawer_of
from fractalcontact.figures.kit.drawing import print_style
from fractalcontact.pages import first_screen, result_page
from fractalcontact.pages.common_loads import CommonLoad, common_loads, main_load
from fractalcontact.pages.files import FILES
from fractalcontact.pages.first_screen import block_of, quoted_methods
from fractalcontact.pages.lights import (
    FILLED,
    MARKS,
    Light,
    _finer,
    _without_scan,
    lights_of,
    trust_of,
    validity_at,
)
from fractalcontact.pages.matrix import (
    checks_of,
    controls_of,
    counted,
    matrix_of,
    of_study,
)
from fractalcontact.pages.summary import sheet_of
from fractalcontact.report.published import BY_SCAN, Number, read_at, row_of
from fractalcontact.roughness.quality_words import overlap_words
from fractalcontact.statements.comparison import compared_pressures
from fractalcontact.statements.judge import rule_of
from fractalcontact.study.atlas import read_atlas, write_atlas
from fractalcontact.study.figure_list import figures_of

NAMES = ("flat.1", "pair")
VOID = {"meta", "img", "br", "input", "link", "hr"}


class Parsed(HTMLParser):
    """Elements of a page, and whether each is closed where it should be."""

    def __init__(self, path):
        super().__init__()
        self.open, self.elements, self.ids, self.texts = [], [], [], []
        self.feed(path.read_text(encoding="utf-8"))
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        if "id" in dict(attrs):
            self.ids.append(dict(attrs)["id"])
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open, f"</{tag}> ends nothing"
        # A paragraph or an entry of a list may end by itself; here none does.
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.texts.append(data)

    def addresses(self):
        return [
            value
            for _, attrs in self.elements
            for name, value in attrs.items()
            if name in ("href", "src", "action", "data", "poster", "srcset")
        ]


@pytest.fixture(scope="module")
def atlas(results):
    return read_atlas(results / "atlas.nc", without=("contact",))


@pytest.fixture(scope="module")
def pages(results):
    paths = [results / "index.html", *sorted((results / "pages").glob("*.html"))]
    assert [path.name for path in paths] == ["index.html", "flat.1.html", "pair.html"]
    return {path: Parsed(path) for path in paths}


def test_every_file_is_made(results):
    assert all((results / name).is_file() for name in FILES)


def test_pages_are_html_whose_names_are_unique(pages):
    for parsed in pages.values():
        assert len(parsed.ids) == len(set(parsed.ids))


def test_links_lead_to_files_of_the_study_and_to_places_in_them(results, pages):
    for path, parsed in pages.items():
        for address in parsed.addresses():
            parts = urlsplit(address)
            if parts.scheme == "data":
                continue
            assert not parts.scheme, address
            assert not parts.netloc, address
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            assert target.is_relative_to(results.resolve()), address
            assert target.is_file(), address
            if parts.fragment and target in pages:
                assert unquote(parts.fragment) in pages[target].ids, address


def test_every_figure_stands_on_its_specimen_s_page(results, pages):
    for name, opposite in (("pair", "match"), ("flat.1", "flat")):
        parsed = pages[results / f"pages/{name}.html"]
        pictures = [attrs["src"] for tag, attrs in parsed.elements if tag == "img"]
        wanted = {f"../figures/{name}/{figure}.png" for figure in figures_of(opposite)}
        assert set(pictures) == wanted
        assert all(attrs["loading"] == "lazy" for tag, attrs in parsed.elements if tag == "img")
        addresses = set(parsed.addresses())
        assert {address.replace(".png", ".csv") for address in wanted} <= addresses
        assert not any(address.endswith((".svg", ".pdf")) for address in addresses)


def test_untrusted_input_is_shown_as_text(results, pages):
    """As the title of its page, in the table, in captions, and in the data of the script."""
    for path, parsed in pages.items():
        text = path.read_text(encoding="utf-8")
        assert "<script>alert" not in text
        assert "x.example" not in "".join(parsed.addresses())
        assert {tag for tag, _ in parsed.elements} >= {"main", "header", "h1"}
    heading = "".join(pages[results / "pages/pair.html"].texts)
    assert HOSTILE in heading
    data = re.search(
        r'id="curves-data">(.*?)</script>', (results / "index.html").read_text("utf-8"), re.DOTALL
    )
    assert {row["label"] for row in json.loads(data[1])} == {HOSTILE, FORMULA}


def test_nothing_is_fetched(pages):
    """The policy allows none, and no text of ours asks for any."""
    for path, parsed in pages.items():
        (policy,) = [a["content"] for tag, a in parsed.elements if a.get("http-equiv")]
        assert "default-src 'none'" in policy
        text = re.sub(r"http://www\.w3\.org/2000/svg", "", path.read_text(encoding="utf-8"))
        assert re.findall(r"https?://(?!x\.example)", text) == []
        assert "fetch(" not in text
        assert "innerHTML" not in text


def test_verdicts_are_those_of_the_atlas(results, atlas, pages):
    rows = matrix_of(atlas, ["flat.1", "pair"])
    asked = 0
    for name in ("flat.1", "pair"):
        table = atlas[f"statements/{name}"].to_dataset()
        for statement in table["statement"].values:
            (row,) = [row for row in rows if row.name == statement]
            found = table.sel(statement=statement)
            assert row.cells[name].verdict == found["verdict"].item()
            assert row.cells[name].numbers == found["numbers"].item()
            assert row.rule  # the first sentence of what judges it
            assert f"statement-{statement}" in pages[results / f"pages/{name}.html"].ids
            assert f"{name}--{statement}" in pages[results / "index.html"].ids
            asked += 1
    assert asked == sum(len(row.cells) for row in rows)
    # Elimination is a check of the solver.
    assert [row.name for row in checks_of(rows)] == ["elimination_finds_the_set"]
    assert sum(counted(rows).values()) <= asked - 2
    assert controls_of(rows) == []


def test_a_specimen_none_of_whose_verdicts_counts_is_a_control(atlas):
    name = "statements/flat.1"
    known = atlas.copy()
    table = known[name].to_dataset()
    known[name] = xr.DataTree(table.assign(counted=xr.zeros_like(table["counted"])))
    rows, before = matrix_of(known, ["flat.1", "pair"]), matrix_of(atlas, ["pair"])
    assert controls_of(rows) == ["flat.1"]
    assert counted(rows) == counted(before)


def test_verdicts_are_counted_and_their_table_has_each_of_them(results, atlas, pages):
    rows = [*matrix_of(atlas, ["flat.1", "pair"]), *of_study(atlas)]
    words = ", ".join(f"{verdict} {count}" for verdict, count in counted(rows).items())
    assert words in "".join(pages[results / "index.html"].texts)
    table = pd.read_csv(results / "statements.csv", keep_default_na=False)
    found = table.set_index(["specimen", "statement"])
    assert len(found) == sum(len(row.cells) for row in rows)
    for row in rows:
        for specimen, cell in row.cells.items():
            assert found.loc[(specimen, row.name), "verdict"] == cell.verdict
            assert found.loc[(specimen, row.name), "counted"] == cell.counted


def test_the_solve_plan_of_the_atlas_stands_on_the_page(results, atlas, pages):
    plan = atlas["choices/pair"].to_dataset()
    shown = "".join(pages[results / "pages/pair.html"].texts)
    assert f"{int(atlas['closure/pair']['solved'].sum())} of {plan.attrs['states']} states" in shown
    for value in plan["value"].values:
        assert str(value) in shown


def test_curves_of_two_studies_are_laid_over_each_other_as_documented(
    results, tmp_path, monkeypatch
):
    (tmp_path / "results").mkdir()
    for study in ("paper", "mine"):
        (tmp_path / "results" / study).symlink_to(results)
    monkeypatch.chdir(tmp_path)
    closure = run_code("docs/result_page.md")["closure"]
    own = pd.read_csv(results / "curves.csv")
    assert len(closure) == 2 * (own["quantity"] == "closure from the seat").sum() > 0


def test_no_page_and_no_table_shows_markup_of_docstrings(results, pages):
    assert len(pages) > 2
    for page, parsed in pages.items():
        assert not MARKUP.search("".join(parsed.texts)), page
    for path in results.glob("*.csv"):
        assert not MARKUP.search(path.read_text(encoding="utf-8")), path
    for name in claims_of("one"):
        assert not MARKUP.search(inspect.getdoc(rule_of(name))), name


@pytest.mark.parametrize(
    ("place", "words"),
    [("7", "Fig. 7"), ("4, 5", "Figs. 4, 5"), ("sect. 3", "sect. 3"), ("eq. 2", "eq. 2")],
)
def test_the_place_of_a_claim_in_the_paper_is_in_words(place, words):
    assert result_page._in_paper(place) == words


def test_every_statement_leads_to_a_figure_that_its_specimen_has(atlas):
    for specimen, drawn in (("pair", figures_of("match")), ("flat.1", figures_of("flat"))):
        shown = {row.name: row.cells[specimen].figure for row in matrix_of(atlas, [specimen])}
        assert set(shown.values()) <= {*drawn, ""}
        assert len(set(shown.values())) > 3


def test_a_light_that_is_not_good_says_what_would_help(atlas):
    lights = [one for name in NAMES for one in lights_of(Subject.of(atlas, name))]
    assert all(bool(one.help) == (one.word in ("partly", "poor")) for one in lights)
    assert {one.key for one in lights if one.help} >= {"model"}
    # Few nodes ask for a load that the force scales to.
    few = with_told(atlas, f"closure/{NAMES[0]}", nodes=15)
    subject = Subject.of(few, NAMES[0])
    (nodes,) = [one for one in lights_of(subject) if one.key == "nodes"]
    force = with_unit(2 * float(subject.reported.force), "N")
    assert nodes.help == f"a finer scan, or heavier loads (about {force})"


def test_the_light_of_the_grid_leaves_out_the_error_of_the_scan(atlas):
    subject = Subject.of(atlas, "pair")
    closure, budget = (subject[of].copy() for of in ("closure", "error_budget"))
    closure["seated_closure"] = xr.full_like(closure["seated_closure"], 0.4)
    for name, error in (("total", 0.5), ("scan", 0.3)):
        name = f"seated_closure_{name}"
        budget[name] = xr.full_like(budget[name], error)
    changed = {"closure": closure, "error_budget": budget}
    assert _without_scan(replace(subject, stages={**subject.stages, **changed})) == pytest.approx(
        0.5
    )


def test_the_grid_asks_for_the_spacing_that_its_order_of_convergence_gives():
    subject = {"specimens": xr.Dataset(attrs={"spacing_x": 0.4})}
    assert _finer(subject, 4.0, 2.0) == f"a spacing of {with_unit(0.2, 'mm')} or finer"
    assert _finer(subject, 4.0, np.nan) == "a finer scan"


def test_lights_follow_what_the_stages_say(atlas):
    """A pair whose faces overlap, few nodes, a grid too coarse; and the same without them."""
    words = {
        name: {one.key: one.word for one in lights_of(Subject.of(atlas, name))} for name in NAMES
    }
    assert words["flat.1"]["faces"] == "not judged"
    pair = Subject.of(atlas, "pair")
    note = overlap_words(pair["specimens"], pair["quality"])
    assert pair["quality"].attrs["overlap"] == note
    assert next(one for one in lights_of(pair) if one.key == "faces").reason.endswith(note)
    for name in NAMES:
        subject = Subject.of(atlas, name)
        nodes = subject.state("closure")["nodes"].item()
        wanted = "good" if nodes >= 30 else "partly" if nodes >= 10 else "poor"
        assert words[name]["nodes"] == wanted
        budget = subject["error_budget"].sel(quantity="closure")
        error = budget["relative_error"].sel(source="numerical").values[subject.reported.reference]
        wanted = "good" if error <= 0.01 else "partly" if error <= 0.1 else "poor"
        assert words[name]["grid"] == wanted
    changed = atlas.copy()
    changed["closure/pair"].attrs["warning"] = "suspicious cells carry all"
    assert {one.key: one.word for one in lights_of(Subject.of(changed, "pair"))}["faces"] == "poor"
    changed["closure/flat.1"].attrs["warning"] = "spikes carry all"
    assert {one.key: one.word for one in lights_of(Subject.of(changed, "flat.1"))}["scan"] == "poor"
    changed["closure/flat.1"].attrs["warning"] = ""
    changed["quality/flat.1"].attrs["warning"] = ""
    assert {one.key: one.word for one in lights_of(Subject.of(changed, "flat.1"))}["scan"] == "good"


def test_page_summary_and_figure_quote_one_verdict_on_the_elastic_model(results, pages):
    """Under the load of the maps: the light, the column of the summary, the caption of Fig. 8."""
    atlas = read_atlas(results / "atlas.nc")
    table = pd.read_csv(results / "summary.csv")
    for name in NAMES:
        subject = Subject.of(atlas, name)
        found = validity_at(subject, subject.reported.reference)
        (light,) = [one for one in lights_of(subject) if one.key == "model"]
        assert light.word == found.verdict
        assert light.reason.endswith(found.reason)
        rows = table[table["specimen"] == name]
        assert set(rows["light_model"]) == {found.verdict}
        (row,) = rows[rows["load_of_maps"]].itertuples()
        assert row.elastic_model == found.verdict
        few = rows["contact_nodes"].values < 30
        assert (rows["real_pressure_MPa"].isna().values == few).all()
        assert (rows["elastic_model"] == "not judged").values.tolist() == few.tolist()
        assert row.elastic_model_good_to_MPa == 80  # the joint wall strength of the study
        assert found.reason in "".join(pages[results / f"pages/{name}.html"].texts).replace(
            "σn", "sigma_n"
        )
        with print_style():
            caption = drawer_of("fig08_prefractals")(atlas, name).caption
        assert found.reason in caption
        assert f"The contact model is {found.verdict}" in caption.heading


def test_specimens_are_compared_at_one_nominal_pressure(results, atlas):
    """Each choice of the page is one pressure, within 5 %, and has all that were solved there."""
    subjects = [Subject.of(atlas, name) for name in NAMES]
    loads = common_loads(subjects, atlas["study_comparison/study"].to_dataset())
    assert [load.pressure for load in loads] == pytest.approx([1, 125, 250])
    for load in loads:
        for one in subjects:
            assert one["closure"]["nominal_pressure"].values[
                load.numbers[one.name]
            ] == pytest.approx(load.pressure, rel=0.05)
    assert main_load(loads, subjects).pressure == pytest.approx(125)
    text = (results / "index.html").read_text(encoding="utf-8")
    assert text.count(" selected>125 MPa (2 of 2)") == 1


class Solved:
    """What :func:`common_loads` reads of a specimen."""

    def __init__(self, name, pressures, quoted, reference, unsolved=()):
        closure = np.ones(len(pressures))
        closure[list(unsolved)] = np.nan
        values = {"nominal_pressure": np.array(pressures), "closure": closure}
        self.name, self.curves = name, xr.Dataset({k: ("load", v) for k, v in values.items()})
        self.reported = SimpleNamespace(quoted=quoted, reference=reference)

    def __getitem__(self, stage):
        return self.states(stage)

    def states(self, stage):
        return self.curves


def test_pressures_that_differ_by_their_windows_alone_are_one():
    twin = Solved("twin", [2.5, 25, 75], [0, 1], 1)
    other = Solved("other", [7.6, 25.4, 76.2], [1, 2], 2)
    pressures = [one.curves["nominal_pressure"].values for one in (twin, other)]
    compared = {"compared_pressure": (("specimen", "load"), compared_pressures(pressures))}
    loads = common_loads([twin, other], xr.Dataset(compared, {"specimen": ["twin", "other"]}))
    assert [load.numbers for load in loads] == [
        {"twin": 0},
        {"twin": 1, "other": 1},
        {"twin": 2, "other": 2},
    ]
    assert main_load(loads, [twin, other]).pressure == pytest.approx(75.6)
    unsolved = Solved("unsolved", [2.5, 25, 75], [1], 1, unsolved=[1])
    assert common_loads([unsolved]) == []
    assert main_load([], []) is None


def test_the_load_shown_first_has_most_specimens_then_most_maps_then_the_largest_pressure():
    subjects = [
        Solved(name, [10, 20, 30], [0], reference)
        for name, reference in zip("abc", (1, 1, 2), strict=True)
    ]
    of_all = CommonLoad("p0", 10, dict.fromkeys("abc", 0))
    of_two, of_two_maps = (
        CommonLoad("p1", 30, {"a": 2, "b": 2}),
        CommonLoad("p2", 20, {"a": 1, "b": 1}),
    )
    largest = CommonLoad("p3", 25, {"a": 0, "b": 0})
    assert main_load([of_two_maps, of_all], subjects) is of_all
    assert main_load([of_two, of_two_maps], subjects) is of_two_maps
    assert main_load([largest, of_two], subjects) is of_two


def test_each_load_quoted_has_a_pressure_near_it_however_close_the_next_ones_are():
    row = [Solved(f"{n}", [10 * 1.04**n], [0], 0) for n in range(5)]
    pressures = [one.curves["nominal_pressure"].values for one in row]
    compared = {"compared_pressure": (("specimen", "load"), compared_pressures(pressures))}
    loads = common_loads(row, xr.Dataset(compared, {"specimen": [one.name for one in row]}))
    assert {name for load in loads for name in load.numbers} == {one.name for one in row}
    for load in loads:
        near = [pressures[int(name)][i] for name, i in load.numbers.items()]
        assert near == pytest.approx([load.pressure] * len(near), rel=0.05)


def with_told(atlas, group, **values):
    """The atlas with some variables of a group told anew, one value in all places."""
    changed = atlas.copy()
    dataset = atlas[group].to_dataset().load()
    for name, value in values.items():
        dataset[name] = xr.full_like(dataset[name], value)
    changed[group] = xr.DataTree(dataset)
    return changed


def test_k_ni_is_as_determined_as_the_atlas_says(results, atlas):
    table = pd.read_csv(results / "summary.csv").set_index("specimen")
    for name in NAMES:
        for high, says, determined, reason in (
            (200.0, True, True, ""),
            (200.0, False, False, "it is told so"),
            (1e4, True, False, TOO_WIDE),
        ):
            ends = {"k_ni": 100.0, "k_ni_low": 90.0, "k_ni_high": high}
            why = "it is told so" if not says else ""
            told = {"k_ni_determined": says, "k_ni_reason": why}
            changed = with_told(atlas, f"error_budget/{name}", **ends, **told)
            found = sheet_of(Subject.of(changed, name)).of("k_ni")
            assert found.estimate.ends == (100, 90, high)
            assert (found.determined, found.remark) == (determined, reason)
        row = table.loc[[name]].iloc[0]
        known = Subject.of(atlas, name)["error_budget"]
        assert row["k_ni_determined"] == known["k_ni_determined"].item()
        assert row["k_ni_reason"] == known["k_ni_reason"].item()


def test_the_dilatancy_of_the_summary_is_the_plateau_of_the_atlas(atlas):
    told = {"plateau_trend": "falling", "plateau_level": 0.7, "plateau_slope": -0.2}
    found = sheet_of(Subject.of(with_told(atlas, "joints/pair", **told), "pair"))
    assert [found.of(f"dilatancy_{of}").value for of in ("level", "slope")] == [0.7, -0.2]
    undecided = Subject.of(atlas, "pair").along("joints")["plateau_undecided"].item()
    assert found.words["dilatancy"] == "falling"
    assert found.words["dilatancy_undecided"] == undecided
    none = with_told(atlas, "joints/pair", plateau_trend="", plateau_level=np.nan)
    for subject, why in (
        (Subject.of(none, "pair"), "too few offsets"),
        (Subject.of(atlas, "flat.1"), "does not slide"),
    ):
        found = sheet_of(subject)
        assert found.words["dilatancy"] == "none"
        assert found.of("dilatancy_level").missing == why


def test_the_verdict_on_the_elastic_model_is_that_of_the_atlas(results):
    """On the page, in its light and in the caption of Fig. 8, which judge nothing themselves."""
    atlas = read_atlas(results / "atlas.nc")
    told = {"verdict": "partly", "reason": "it is told so", "pressure": 7.0, "good_to": 5.0}
    for name in NAMES:
        changed = with_told(atlas, f"elastic_model/{name}", **told)
        sheet = sheet_of(Subject.of(changed, name))
        assert {(one.verdict, one.reason, one.pressure) for one in sheet.models.values()} == {
            ("partly", "it is told so", 7.0)
        }
        (light,) = [one for one in sheet.lights if one.key == "model"]
        assert (light.word, light.reason.split(", ")[1]) == ("partly", "it is told so")
        with print_style():
            caption = drawer_of("fig08_prefractals")(changed, name).caption
        assert "it is told so." in caption
        assert caption.heading == "The contact model is partly good"


def test_the_first_screen_has_a_block_of_each_joint(results, atlas):
    html = (results / "index.html").read_text(encoding="utf-8")
    for name in NAMES:
        block = block_of(Subject.of(atlas, name), synthetic=False)
        shown = re.search(rf'id="joint-{re.escape(name)}">(.*?)</article>', html, re.DOTALL)[1]
        assert f"Trust: {block['trust'].word}." in shown
        for fact in block["facts"]:
            assert f"<dt>{fact.title}</dt><dd><strong>{fact.words}</strong>" in shown
            assert fact.words != "–" or fact.notes
        for ending in ("html", "yaml", "json"):
            assert f'href="cards/{name}.{ending}"' in shown
        assert {fact.title.partition(" at ")[2] for fact in block["facts"]} <= {"125 MPa", ""}
        assert block["window"].startswith("window ")
        assert block["window"].capitalize() in shown
    assert "at no offset" in html
    assert quoted_methods("none", results) == {}


@pytest.fixture
def facts_with(atlas, monkeypatch):
    """First numbers of a joint, some of them replaced."""

    def facts(synthetic=False, specimen="pair", **numbers):
        def read(row, subject):
            return numbers.get(row.name) or read_at(row, subject)

        monkeypatch.setattr(first_screen, "read_at", read)
        return first_screen.facts_of(Subject.of(atlas, specimen), synthetic)

    return facts


def of(value, low=np.nan, high=np.nan, **fields):
    return Number({"pressure": 125.0}, Estimate(value, low, high), **fields)


def test_a_number_that_suspicious_cells_decide_is_undetermined_and_says_why(facts_with):
    fact = facts_with(mean_gap=of(0.1, 0.09, 0.11, determined=False))[2]
    assert fact.words == "undetermined"
    assert fact.notes[0] == f"0.1 mm: {BY_SCAN}"


def changed(subject, seat=None, share=None, **attrs):
    """A specimen with other attributes, another seat (MPa) and force on suspicious cells."""
    closure = subject["closure"].copy()
    if seat is not None:
        closure["seating_pressure"] = xr.full_like(closure["seating_pressure"], seat)
        closure["suspect_load_share"] = xr.full_like(closure["suspect_load_share"], share)
    specimen = subject["specimens"].assign_attrs(attrs)
    stages = {**subject.stages, "closure": closure, "specimens": specimen}
    settings = subject.settings | {"seating_pressure": 0.0}
    return replace(subject, stages=stages, settings=settings)


def test_the_first_screen_says_why_the_seat_is_no_lighter_load(atlas):
    subject = Subject.of(atlas, "pair")
    heaviest = float(subject["closure"]["nominal_pressure"][-1])
    why = "as suspicious cells of the scan carry most of lighter loads"
    for share, outliers, words in (
        (0.9, "keep", f", {why}; 'outliers: fill' in its sidecar shows what that changes"),
        (0.9, "fill", f", {why}"),
        (0.1, "keep", ""),
    ):
        block = first_screen._Block(changed(subject, heaviest, share, outliers=outliers), False)
        assert block._why_no_lighter_seat() == words
    lightest = float(subject["closure"]["nominal_pressure"][0])
    assert first_screen._Block(changed(subject, lightest, 0.9), False)._why_no_lighter_seat() == ""


def test_one_face_has_an_assumed_offset_and_the_range_over_others(atlas):
    pair = Subject.of(atlas, "pair")
    one = changed(pair, opposite="match")
    gaps = pair.reported.curves(pair["closure"])["mean_gap"].sel(normal_force=pair.reported.force)
    others = gaps.where((gaps["offset"] > 0) & (gaps["offset"] != pair.offset), drop=True)
    assert others.size
    words = first_screen._Block(one, False)._at_offsets(row_of("mean_gap"), 1.0, " mm")
    for end in (others.min(), others.max()):
        assert short(float(end)) in words
    assert words.endswith(" mm)")
    # Nothing is assumed of a pair, nor of a face that the study generates.
    assert first_screen._Block(pair, False)._at_offsets(row_of("mean_gap"), 1.0, " mm") == ""
    assert first_screen._Block(one, True)._at_offsets(row_of("mean_gap"), 1.0, " mm") == ""
    closure = one["closure"].assign(reported_offset=float(others["offset"][0]))
    slid = replace(one, stages={**one.stages, "closure": closure})
    assert first_screen.offset_words(slid).startswith("assumed offset ")
    assert first_screen.offset_words(slid, True).startswith("slid by ")


def test_the_strength_is_the_range_of_its_rules(facts_with):
    rules = {"peak_strength": of(26.8), "barton_strength": of(18.9), "contact_strength": of(45.5)}
    rules["barton_scaled_strength"] = of(np.nan, missing="JRC_n is above 20")
    fact = facts_with(**rules)[-1]
    assert fact.words == "18.9 to 45.5 MPa"
    assert fact.notes == [
        "phi_b = 30° assumed",
        "range of 3 rules:",
        *("Barton 18.9", "dilatancy 26.8", "contact 45.5"),
        "no value by Barton and Bandis: JRC_n is above 20",
        *first_screen._EXPLAINED,
    ]
    bound = "only a lower bound, as most angles are truncated at 70 degrees"
    fact = facts_with(**rules | {"contact_strength": of(40.0, missing=bound)})[-1]
    assert fact.words == "18.9 to 26.8 MPa"
    assert f"no value by contact: {bound}" in fact.notes
    none = {name: of(np.nan, missing=f"none by {name}") for name in rules}
    assert facts_with(**none)[-1][1:] == ("–", ["none by peak_strength"])


def test_the_first_screen_says_what_no_interval_holds(facts_with):
    """Hardness of single contacts, the spacing, the slope of the gap."""
    contact = of(0.0333, 0.033, 0.034, hardest=0.0111)
    crushing = {"hardness": of(150.0), "hardest_hardness": of(450.0)}
    of_plane = facts_with(
        specimen="flat.1", contact_fraction=contact, area_share=of(125.0 / 150.0), **crushing
    )
    assert len(of_plane) == 4
    assert of_plane[3].words == "3.33 %"
    assert of_plane[3].notes == [
        "[3.30,\u00a03.40] of these heights as gridded",
        "1.11 if contacts are 3 times as hard",
        "all contacts crush: pressure over hardness, whatever the scan",
    ]
    facts = facts_with(
        stiffness_change=of(-0.086),
        hydraulic_aperture=of(0.5),
        gap_slope=of(1.3),
        **crushing,
    )
    assert "changes by −8.6 % at twice the spacing" in facts[0].notes
    assert facts[2].notes[-1].endswith("; cubic law not valid (gap slope 1.3)")
    assert [fact.title for fact in facts[3:]] == ["JRC", "shear strength at 125 MPa"]


WHOLE = "; other windows of the joint may differ by any amount"


def test_closure_counts_from_first_touch_where_none_counts_from_the_seat(facts_with):
    touch, seat = of(0.5), {"seating_pressure": of(2.0)}
    for seated in (of(0.0), of(np.nan, missing="below the seat")):
        fact = facts_with(seated_closure=seated, interface_closure=touch, **seat)[1]
        assert (fact.words, fact.notes[-1]) == ("0.5 mm", "counted from first touch")
    fact = facts_with(seated_closure=of(0.25), interface_closure=touch, **seat)[1]
    assert fact.words == "0.25 mm"
    assert fact.notes[-1].startswith("counted from 2 MPa")


def test_the_trust_names_the_cause_before_its_symptoms():
    scan = Light("scan", "Scan", "poor", "noise", "a finer scan")
    model = Light("model", "Validity of the model", "poor", "steep faces", "lighter loads")
    trust = trust_of([scan, model])
    assert trust.reason == "Scan: noise. Also poor: model"
    assert trust.help == "a finer scan"
    assert trust_of([model]) == ("low", "Validity of the model: steep faces", "lighter loads")
    nodes = Light("nodes", "Contact nodes", "poor", "9 nodes", "heavier loads")
    assert trust_of([nodes, model]).help == "lighter loads"
    # What no model helps against comes first: errors of two scans.
    for helps in (MARKS, FILLED):
        pair = Light("faces", "Fit of the faces", "poor", "they overlap", helps)
        assert trust_of([scan, pair, model]).reason.startswith("Fit of the faces: they overlap")


@pytest.mark.parametrize(
    ("half", "synthetic", "words"),
    [
        (0.25, False, "[0.184,\u00a00.684] whole joint"),
        (3.2, False, f"{WHOLE}; 'twins: 20' in its sidecar narrows this"),
        (3.2, True, WHOLE),
    ],
)
def test_an_error_larger_than_its_number_leaves_it_unknown(facts_with, half, synthetic, words):
    number = of(0.434, 0.431, 0.436, population=half)
    note = facts_with(synthetic, mean_gap=number)[2].notes[0]
    holds = "this surface" if synthetic else "of these heights as gridded"
    assert note.removeprefix(f"[0.431,\u00a00.436] {holds}") == words


def test_synthetic_joints_stand_behind_scanned_ones_under_their_own_heading(
    results, tmp_path, monkeypatch
):
    shutil.copytree(results, tmp_path / "tiny")
    monkeypatch.setattr(result_page, "is_synthetic", lambda name, study: name == "flat.1")
    result_page.write_index(result_page.Place.of(tmp_path / "tiny"), [])
    html = (tmp_path / "tiny/index.html").read_text(encoding="utf-8")
    places = [html.index(f'id="{name}"') for name in ("joint-pair", "synthetic", "joint-flat.1")]
    assert places == sorted(places)


def test_the_summary_states_what_twice_the_spacing_changes(atlas):
    """As the caption of the closure figure has it."""
    for name in NAMES:
        subject = Subject.of(atlas, name)
        curves = subject["closure"].sel(direction=subject.direction)
        curves = curves.sel(offset=subject.offset, method="nearest")
        tangent = curves["interface_stiffness"].isel(normal_force=subject.reported.reference).values
        initial = curves["seated_k_ni"].values
        found = sheet_of(subject)
        assert found.of("stiffness_change").value == pytest.approx(tangent[1] / tangent[0] - 1)
        change = found.of("k_ni_change").value
        assert change == pytest.approx(initial[1] / initial[0] - 1, nan_ok=True)


def test_a_page_states_material_and_opposite_face(results, pages):
    table = pd.read_csv(results / "summary.csv").set_index("specimen")
    for name, words in (("pair", "both faces scanned"), ("flat.1", "against a rigid plane")):
        text = "".join(pages[results / f"pages/{name}.html"].texts)
        row = table.loc[[name]].iloc[0]
        assert row["material"] == "rock"
        modulus = with_unit(row["modulus_MPa"], "MPa")
        assert f"material rock: E = {modulus}, ν = {row['poisson']:g}" in text
        assert words in text
        assert np.isnan(row["hardness_MPa"])


def test_tables_and_configuration_can_be_used_again(results):
    assert yaml.safe_load((results / "study.yaml").read_text(encoding="utf-8")) == STUDY
    with zipfile.ZipFile(results / "tables.zip") as archive:
        names = archive.namelist()
        assert archive.testzip() is None
        assert archive.read("summary.csv") == (results / "summary.csv").read_bytes()
    figures = {path.relative_to(results).as_posix() for path in results.rglob("figures/*/*.csv")}
    assert set(names) == figures | {"summary.csv", "curves.csv", "statements.csv"}


def test_no_table_has_a_cell_that_a_spreadsheet_runs(results):
    with zipfile.ZipFile(results / "tables.zip") as archive:
        tables = {name: archive.read(name).decode() for name in archive.namelist()}
    assert f"'{FORMULA}" in tables["summary.csv"]
    assert f"'{FORMULA}" in tables["curves.csv"]
    assert {name: found for name, text in tables.items() if (found := formulas_in(text))} == {}


@pytest.mark.full
def test_the_same_results_are_the_same_pages(results, tmp_path):
    shutil.copytree(results, tmp_path / "tiny", copy_function=shutil.copy2)
    write_pages(tmp_path / "tiny")
    for path in [*results.glob("*.*"), *results.glob("pages/*")]:
        if path.is_file():
            again = tmp_path / "tiny" / path.relative_to(results)
            assert again.read_bytes() == path.read_bytes(), path.name


def test_a_study_without_specimens_has_a_page(tmp_path):
    """One of synthetic surfaces or of measured maps alone."""
    write_atlas(
        {}, tmp_path / "atlas.nc", study="none", configuration={"study": {}, "settings": {}}
    )
    assert write_pages(tmp_path) == []
    text = "".join(Parsed(tmp_path / "index.html").texts)
    assert "Study none" in text
    assert "Specimens" not in text
    assert list(pd.read_csv(tmp_path / "summary.csv").columns) == ["study", "specimen"]


@pytest.mark.full
def test_a_page_without_pictures_has_none(results, tmp_path):
    """One that was removed, or is drawn later: what is there is shown, and nothing is promised."""
    shutil.copytree(results, tmp_path / "tiny")
    shutil.rmtree(tmp_path / "tiny/figures/pair")
    write_pages(tmp_path / "tiny")
    parsed = Parsed(tmp_path / "tiny/pages/pair.html")
    assert not any(tag == "img" for tag, _ in parsed.elements)
    index = Parsed(tmp_path / "tiny/index.html")
    assert not any("figures/pair" in address for address in index.addresses())
