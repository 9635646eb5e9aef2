"""The explorer in a real browser: it shows the atlas's numbers, each control does what it says."""

import re
import time

import numpy as np
import pytest
from page_drawings import assert_readable

pytestmark = [pytest.mark.browser, pytest.mark.workflow]
DRAWN = "body[data-drawn]"
DIMENSIONS = ("direction", "offset", "resolution", "normal_force")
#: Rows of a contact map from the South, a letter a pixel: black is contact, white is not.
LETTERS = """who => {
  const canvas = document.querySelector(`[data-state=${who}] canvas`);
  const { width, height } = canvas;
  const data = canvas.getContext("2d").getImageData(0, 0, width, height).data;
  const letter = (i) => {
    const colour = `${data[i]} ${data[i + 1]} ${data[i + 2]}`;
    return { "0 0 0": "#", "255 255 255": "." }[colour] || "?";
  };
  return Array.from({ length: height }, (_, row) =>
    Array.from({ length: width }, (_, x) => letter(4 * ((height - 1 - row) * width + x))).join(""));
}"""
#: The colours of its pixels.
PIXELS = """who => {
  const canvas = document.querySelector(`[data-state=${who}] canvas`);
  const { width, height } = canvas;
  const data = canvas.getContext("2d").getImageData(0, 0, width, height).data;
  const rows = [];
  for (let y = height - 1; y >= 0; y--)
    rows.push(Array.from({ length: width }, (_, x) => {
      const i = 4 * (y * width + x);
      return [data[i], data[i + 1], data[i + 2]];
    }));
  return rows;
}"""


class Explorer:
    """The page, by its controls."""

    def __init__(self, page):
        self.page = page
        page.wait_for_selector(DRAWN)

    def panel(self, who="a"):
        return self.page.locator(f"[data-state={who}]")

    def redrawn(self, act):
        """Do something, and wait until everything was drawn anew."""
        self.page.evaluate("delete document.body.dataset.drawn")
        act()
        self.page.wait_for_selector(DRAWN)

    def visit(self, view):
        """Follow a link to another view of the page."""
        self.redrawn(lambda: self.page.evaluate("view => { location.hash = view; }", view))

    def choose(self, name, who="a"):
        select = self.panel(who).locator(".specimen")
        option = select.locator("option").filter(has_text=name).first
        self.redrawn(lambda: select.select_option(option.get_attribute("value")))

    def slide(self, control, index, who="a"):
        slider = self.panel(who).locator(f"input.{control}")
        if slider.is_enabled():
            self.redrawn(lambda: slider.fill(str(index)))

    def pick(self, control, index, who="a"):
        label = self.panel(who).locator(f".{control} label").nth(index)
        if not label.locator("input").is_checked():
            self.redrawn(lambda: label.click())

    def go(self, place, who="a"):
        """Set direction, offset, resolution and force by their indices."""
        self.pick("direction", place[0], who)
        self.slide("offset", place[1], who)
        self.pick("resolution", place[2], who)
        self.slide("load", place[3], who)

    def field(self, name):
        self.redrawn(lambda: self.page.locator("#view label", has_text=name).first.click())

    def toggle(self, control):
        self.redrawn(lambda: self.page.locator(f"#{control}").click())

    def values(self, who="a"):
        """Numbers and words of the table, by quantity."""
        cells = self.page.locator(f"#values td.{who}[data-value]")
        rows = cells.evaluate_all(
            "cells => cells.map(c => [c.parentElement.dataset.key, c.dataset.value, c.textContent])"
        )
        return {key: (float(value), words) for key, value, words in rows}

    def words(self, who="a"):
        """Words of the table alone."""
        return {key: words for key, (_, words) in self.values(who).items()}

    def contact(self, who="a"):
        """Which nodes are drawn as contact, where nothing is marked."""
        letters = np.array([list(row) for row in self.page.evaluate(LETTERS, who)])
        assert set(np.unique(letters)) <= {"#", "."}
        return letters == "#"

    @property
    def view(self):
        return self.page.locator("#link").input_value()


def state_of(atlas, name, place):
    """Values of a state in the atlas, by what the page calls them; and the state's coordinates."""
    curves = atlas[f"closure/{name}"].to_dataset()
    where = {
        dimension: curves[dimension].values[index]
        for dimension, index in zip(DIMENSIONS, place, strict=True)
    }
    stages = {
        stage: atlas[f"{stage}/{name}"].to_dataset() for stage in ("closure", "domains", "scaling")
    }
    dilatancy = atlas[f"dilatancy/{name}"].to_dataset().drop_dims("direction")
    stages["dilatancy"] = dilatancy.rename(contact_direction="direction")
    # Of the reported offset alone: elsewhere there is no flow.
    flow = atlas[f"flow/{name}"].to_dataset()
    there = {
        key: [curves[f"reported_{key}"].item()] for key in ("direction", "offset", "resolution")
    }
    flow = flow[[key for key, data in flow.items() if data.dims == ("normal_force",)]]
    stages["flow"] = flow.expand_dims(there).reindex({key: curves[key] for key in there})
    values = {}
    for stage, dataset in stages.items():
        for variable, data in dataset.data_vars.items():
            if set(data.dims) <= set(DIMENSIONS) and data.dtype.kind in "fib":
                at = {dimension: where[dimension] for dimension in data.dims}
                values[f"{stage}/{variable}"] = float(data.sel(at))
    return values, where


def number_in(words):
    """The first number of words such as "0.3601 ± 2.6 × 10⁻⁸"."""
    raised = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
    number = r"(?:undetermined \()?(-?[\d.]+)(?: × 10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+))?"
    mantissa, power = re.match(number, words.replace("−", "-")).groups()
    return float(mantissa) * 10.0 ** int((power or "0").translate(raised))


def specimens_of(atlas):
    return sorted(atlas["closure"].children)


def random_places(atlas, n):
    """Specimens and indices of states, most of them solved."""
    rng = np.random.default_rng(0)
    names = specimens_of(atlas)
    for i in range(n):
        name = names[i * len(names) // n]
        solved = atlas[f"closure/{name}"]["solved"].transpose(*DIMENSIONS).values
        among = np.argwhere(solved if rng.random() < 0.85 else np.ones_like(solved))
        yield name, tuple(int(index) for index in rng.choice(among))


#: Rows that have the total error of a quantity of the error budget.
TOTALS = {
    "closure/closure": "closure",
    "closure/interface_closure": "closure",
    "closure/interface_stiffness": "stiffness",
}


def test_errors_and_the_word_undetermined_are_those_of_the_result_page(open_page, atlas):
    """At the offset of the maps the total error; no solver bound alone passes for an error."""
    by_scan = known = 0
    with open_page("explorer.html") as page:
        explorer = Explorer(page)
        for name in specimens_of(atlas):
            curves = atlas[f"closure/{name}"].to_dataset()
            budget = atlas[f"error_budget/{name}"].to_dataset()
            here = curves.sel(direction=budget.attrs["direction"], resolution=1)
            for offset in here["offset"].values:
                for force in here["normal_force"].values:
                    state = here.sel(offset=offset, normal_force=force)
                    if not state["solved"]:
                        continue
                    place = f"{budget.attrs['direction']}~{offset}~{force}~1"
                    explorer.visit(f"a={name}~{place}")
                    by_own = float(state["suspect_load_share"]) > 0.5
                    # Closure counts from first touch, which the lightest load decides.
                    at_offset = here.sel(offset=offset)
                    touch = np.isfinite(at_offset["closure"].values).argmax()
                    at_touch = float(at_offset["suspect_load_share"][touch]) > 0.5
                    shown_words = explorer.words()
                    for key, quantity in TOTALS.items():
                        words = shown_words[key]
                        if words in ("–", state["interface_stiffness_reason"].item()):
                            continue
                        decided = by_own or (quantity == "closure" and at_touch)
                        at_maps = offset == budget.attrs["offset_mm"]
                        total = float(budget["total"].sel(quantity=quantity, normal_force=force))
                        # A stiffness that its error outweighs by half is undetermined, too.
                        is_wide = at_maps and quantity == "stiffness"
                        is_wide &= total > 0.5 * float(state["interface_stiffness"])
                        is_open = words.startswith("undetermined (")
                        assert is_open == (decided or is_wide), (name, key, words)
                        assert words.endswith("), by the scan") == decided
                        by_scan += decided
                        if at_maps and np.isfinite(total):
                            shown = number_in(words.split(" ± ")[1])
                            assert shown == pytest.approx(total, rel=0.051)
                            known += 1
                        else:
                            assert "error not known (solver’s part" in words
    assert by_scan > 3
    assert known > 20


def test_opens_from_the_disk_and_asks_for_nothing(open_page, results, report, shots):
    begin = time.perf_counter()
    with open_page("explorer.html") as page:
        page.wait_for_selector(DRAWN)
        seconds = time.perf_counter() - begin
        assert page.locator("#message").is_hidden()
        assert page.evaluate("document.querySelectorAll('.plot svg').length") == 5
        page.screenshot(path=shots / "explorer_desktop.png", full_page=True)
    size = (results / "explorer.html").stat().st_size
    assert size < 15e6
    report.append(f"explorer.html: {size / 1e6:.2f} MB, drawn after {seconds:.2f} s")


def test_a_hundred_random_states_show_the_numbers_and_maps_of_the_atlas(open_page, atlas):
    unsolved = compared = 0
    with open_page("explorer.html") as page:
        explorer = Explorer(page)
        for name, place in random_places(atlas, 100):
            expected, where = state_of(atlas, name, place)
            words = "~".join(
                str(where[dimension])
                for dimension in ("direction", "offset", "normal_force", "resolution")
            )
            explorer.visit(f"a={name}~{words}&marks=0")
            shown = explorer.values()
            for key, (value, words) in shown.items():
                np.testing.assert_equal(value, expected[key], err_msg=f"{name} {where} {key}")
                if np.isfinite(value):
                    assert number_in(words) == pytest.approx(value, rel=5.1e-4), (key, words)
                    compared += 1
            field = atlas[f"contact/{name}"][f"in_contact_{where.pop('resolution')}"].sel(where)
            if expected["closure/solved"]:
                contact = explorer.contact()
                assert np.array_equal(contact, field.values == 1)
                assert contact.sum() == expected["closure/nodes"]
            else:
                unsolved += 1
                assert np.isnan(field.values).all()
                missing = {
                    words
                    for key, (value, words) in shown.items()
                    if not np.isfinite(value) and not key.startswith("flow/")
                }
                assert missing == {"not solved"}
                assert explorer.panel().locator("canvas.unsolved").count() == 1
                assert explorer.panel().locator(".missing").is_visible()
    assert compared > 500
    assert 0 < unsolved < 60


def test_what_was_not_solved_is_grey_and_the_nearest_solved_state_a_step_away(open_page, atlas):
    name = next(n for n in specimens_of(atlas) if not atlas[f"closure/{n}"]["solved"].all())
    solved = atlas[f"closure/{name}"]["solved"].transpose(*DIMENSIONS).values
    place = tuple(int(i) for i in np.argwhere(~solved.astype(bool))[0])
    with open_page("explorer.html") as page:
        explorer = Explorer(page)
        explorer.choose(name)
        explorer.go(place)
        for control, axis in (("offset", 1), ("load", 3)):
            along = np.take(np.moveaxis(solved, axis, 0), range(solved.shape[axis]), axis=0)
            here = tuple(i for a, i in enumerate(place) if a != axis)
            marks = explorer.panel().locator(f"input.{control} + .strip i")
            grey = [("unsolved" in mark.get_attribute("class")) for mark in marks.all()]
            assert grey == [not bool(along[(i, *here)]) for i in range(solved.shape[axis])]
        assert np.ptp(np.array(page.evaluate(PIXELS, "a"))) == 0
        explorer.redrawn(lambda: explorer.panel().locator(".nearest").click())
        assert explorer.panel().locator(".missing").is_hidden()
        assert "not solved" not in explorer.words().values()


def test_keys_move_the_sliders_and_the_choices(open_page, atlas):
    name = max(specimens_of(atlas), key=lambda n: atlas[f"closure/{n}"]["solved"].size)
    curves = atlas[f"closure/{name}"].to_dataset()
    with open_page("explorer.html") as page:
        explorer = Explorer(page)
        explorer.choose(name)
        explorer.go((0, 0, 0, 0))
        for control, dimension in (("offset", "offset"), ("load", "normal_force")):
            slider = explorer.panel().locator(f"input.{control}")
            slider.focus()
            explorer.redrawn(lambda: page.keyboard.press("ArrowRight"))
            assert slider.input_value() == "1"
            words = explorer.panel().locator(f".{control}-words").text_content()
            assert slider.get_attribute("aria-valuetext") == words
            unit = {"N": 1, "kN": 1e3, "MN": 1e6, "mm": 1}[words.split()[1]]
            assert float(words.split()[0]) * unit == pytest.approx(
                float(curves[dimension][1]), rel=5e-3
            )
        explorer.panel().locator(".resolution input").first.focus()
        explorer.redrawn(lambda: page.keyboard.press("ArrowRight"))
        values, _ = state_of(atlas, name, (0, 1, 1, 1))
        np.testing.assert_equal(explorer.values()["closure/closure"][0], values["closure/closure"])


def test_dots_stand_at_the_state(open_page, atlas):
    name = specimens_of(atlas)[-1]
    home = atlas[f"contact/{name}"].to_dataset().attrs
    with open_page(f"explorer.html#a={name}") as page:
        explorer = Explorer(page)
        values = {key: value for key, (value, _) in explorer.values().items()}
        expected = {
            "closure": (values["closure/closure"], home["map_load"]),
            "area": (home["map_load"], None),
            "dimension": (home["map_load"], values["domains/delta_sigma"]),
            "dilatancy": (home["map_offset"], values["dilatancy/elastic_dilatancy"]),
        }
        for plot, (x, y) in expected.items():
            dot = page.locator(f"[data-plot={plot}] .dot.a")
            slides = atlas[f"specimens/{name}"].attrs["opposite"] != "flat"
            if (y is not None and not np.isfinite(y)) or (plot == "dilatancy" and not slides):
                assert dot.count() == 0
                continue
            assert float(dot.get_attribute("data-x")) == pytest.approx(x)
            if y is not None:
                assert float(dot.get_attribute("data-y")) == pytest.approx(y)
        before = dot_of(page, "closure")
        explorer.slide("load", 1)
        assert dot_of(page, "closure") != before


def dot_of(page, plot):
    dot = page.locator(f"[data-plot={plot}] .dot.a")
    return dot.get_attribute("data-x"), dot.get_attribute("data-y")


def test_a_point_of_a_curve_leads_to_its_state(open_page, atlas):
    with open_page("explorer.html") as page:
        explorer = Explorer(page)
        explorer.slide("load", 0)
        forces = atlas[f"closure/{specimens_of(atlas)[0]}"]["normal_force"].values
        point = page.locator("[data-plot=closure] .mark.a").last
        explorer.redrawn(lambda: point.click(force=True))
        assert explorer.panel().locator("input.load").input_value() == str(forces.size - 1)


def test_two_states_stand_side_by_side_and_move_apart(open_page, shots):
    with open_page("explorer.html") as page:
        explorer = Explorer(page)
        assert explorer.panel("b").is_hidden()
        explorer.toggle("compare")
        assert explorer.words("a") == explorer.words("b")
        last = page.locator("[data-state=b] .specimen option").count() - 1
        select = explorer.panel("b").locator(".specimen")
        explorer.redrawn(lambda: select.select_option(str(last)))
        before = explorer.words("a")
        explorer.slide("load", 1, "b")
        assert explorer.words("a") == before
        assert explorer.words("b") != before
        assert page.locator("[data-plot=closure] .dot").count() == 2
        a, b = (explorer.panel(who).locator("canvas").bounding_box() for who in "ab")
        assert a["y"] == pytest.approx(b["y"], abs=60)
        assert b["x"] > a["x"] + a["width"]
        page.screenshot(path=shots / "explorer_two_states.png", full_page=True)
        explorer.toggle("compare")
        assert explorer.panel("b").is_hidden()


def test_a_link_restores_the_view(open_page):
    with open_page("explorer.html") as page:
        explorer = Explorer(page)
        explorer.toggle("compare")
        explorer.slide("load", 2)
        explorer.slide("load", 3, "b")
        explorer.field("pressure")
        explorer.toggle("logarithmic")
        view, values = explorer.view, (explorer.words("a"), explorer.words("b"))
    with open_page(f"explorer.html#{view.split('#')[1]}") as page:
        again = Explorer(page)
        assert again.view == view
        assert (again.words("a"), again.words("b")) == values
        assert page.locator("input[value=pressure]").is_checked()
        assert page.locator("#logarithmic").is_checked()
        assert again.panel("b").is_visible()
    for broken in ("a=nothing~X~9~~", "a=%00&b=<b>&map=walrus", "~~~&&=="):
        with open_page(f"explorer.html#{broken}") as page:
            assert Explorer(page).values()


def test_pressure_and_gap_are_the_atlas_s_and_said_to_be_missing_elsewhere(open_page, atlas, shots):
    name = specimens_of(atlas)[-1]
    contact = atlas[f"contact/{name}"].to_dataset()
    load = int(np.abs(contact["normal_force"].values - contact.attrs["map_load"]).argmin())
    touching = np.argwhere(contact["map_pressure"].values[load] > 0)
    row, column = (int(i) for i in touching[len(touching) // 2])
    with open_page(f"explorer.html#a={name}") as page:
        explorer = Explorer(page)
        for field in ("pressure", "gap", "flow"):
            explorer.field(field)
            assert explorer.panel().locator(".stored").is_hidden()
            assert explorer.panel().locator(".colour-key .colours").is_visible()
            page.screenshot(path=shots / f"explorer_{field}.png", full_page=True)
        box = explorer.panel().locator("canvas").bounding_box()
        rows, columns = contact["map_pressure"].shape[1:]
        x = box["x"] + (column + 0.5) / columns * box["width"]
        y = box["y"] + (rows - row - 0.5) / rows * box["height"]
        page.mouse.move(x, y)
        words = explorer.panel().locator(".node").text_content()
        pressure = float(contact["map_pressure"].values[load, row, column])
        assert "in contact" in words
        assert number_in(words.split("p = ")[1].split(" MPa")[0]) == pytest.approx(
            pressure, rel=5.1e-4
        )
        explorer.panel().locator("canvas").focus()
        page.keyboard.press("ArrowRight")
        moved = explorer.panel().locator(".node").text_content()
        assert moved.split(",")[0] != words.split(",")[0]
        kept = np.isfinite(contact["map_gap"].values).any(axis=(1, 2))
        explorer.slide("load", int(np.flatnonzero(~kept)[0]))
        assert explorer.panel().locator(".stored").is_visible()
        assert explorer.panel().locator(".colour-key .colours").count() == 0
        explorer.redrawn(lambda: explorer.panel().locator(".go").click())
        assert explorer.panel().locator(".stored").is_hidden()


def test_the_zoom_keeps_the_node_in_sight(open_page):
    with open_page("explorer.html") as page:
        explorer = Explorer(page)
        canvas, frame = explorer.panel().locator("canvas"), explorer.panel().locator(".canvas")
        canvas.focus()
        for _ in range(5):
            page.keyboard.press("Shift+ArrowLeft")
        before, words = canvas.bounding_box(), explorer.panel().locator(".node").text_content()
        page.locator("#view label", has_text="4×").click()
        after, sight = canvas.bounding_box(), frame.bounding_box()
        assert after["width"] == pytest.approx(4 * before["width"], rel=0.05)
        cursor = explorer.panel().locator(".cursor").bounding_box()
        assert sight["x"] - 9 <= cursor["x"] <= sight["x"] + sight["width"]
        assert sight["y"] - 9 <= cursor["y"] <= sight["y"] + sight["height"]
        assert explorer.panel().locator(".node").text_content() == words


def test_overlaps_are_marked(open_page, atlas, shots):
    pairs = [
        n for n in specimens_of(atlas) if atlas[f"specimens/{n}"].attrs["opposite"] == "scanned"
    ]
    if not pairs:
        pytest.skip("the study has no scanned pair")
    with open_page(f"explorer.html#a={pairs[0]}") as page:
        explorer = Explorer(page)
        assert "overlap" in explorer.panel().locator(".colour-key").text_content()
        hatched = np.array(page.evaluate(PIXELS, "a"))
        page.screenshot(path=shots / "explorer_overlap.png", full_page=True)
        explorer.toggle("marks")
        plain = np.array(page.evaluate(PIXELS, "a"))
        assert "overlap" not in explorer.panel().locator(".colour-key").text_content()
        assert hatched.shape[0] == 3 * plain.shape[0]
        vermilion = (hatched == [213, 94, 0]).all(axis=2)
        assert vermilion.any()
        # Three pixels of the nine of a node: below them one sees whether it is in contact.
        nodes = vermilion.reshape(plain.shape[0], 3, plain.shape[1], 3).sum(axis=(1, 3))
        assert set(np.unique(nodes)) == {0, 3}


def test_what_a_label_says_is_shown_and_not_run(open_page, atlas):
    with open_page("explorer.html") as page:
        explorer = Explorer(page)
        assert explorer.page.locator("img").count() == 0
        shown = page.locator("[data-state=a] .specimen option").all_text_contents()
        for name in specimens_of(atlas):
            assert any(name in words for words in shown)


def test_fits_a_phone_and_takes_a_finger(open_page, shots):
    with open_page("explorer.html", phone=True) as page:
        explorer = Explorer(page)
        width = page.evaluate("[document.documentElement.scrollWidth, innerWidth]")
        assert width[0] <= width[1]
        small = page.evaluate(
            """() => [...document.querySelectorAll("button, select, .choice label, .slider input")]
              .filter((one) => one.offsetParent && one.getBoundingClientRect().height < 43.9)
              .map((one) => one.outerHTML)"""
        )
        assert small == []
        slider = explorer.panel().locator("input.load")
        box = slider.bounding_box()
        explorer.redrawn(lambda: page.touchscreen.tap(box["x"] + 12, box["y"] + box["height"] / 2))
        assert slider.input_value() == "0"
        canvas = explorer.panel().locator("canvas").bounding_box()
        page.touchscreen.tap(canvas["x"] + canvas["width"] / 2, canvas["y"] + 40)
        assert explorer.panel().locator(".node").text_content().startswith("x = ")
        explorer.toggle("compare")
        a, b = (explorer.panel(who).bounding_box() for who in "ab")
        assert b["y"] > a["y"] + a["height"]
        page.screenshot(path=shots / "explorer_phone.png", full_page=True)


def test_the_lines_of_python_give_the_number_beside_them(open_page, results):
    import xarray as xr

    with open_page("explorer.html") as page:
        explorer = Explorer(page)
        code, value = page.locator("#code").text_content(), explorer.values()["closure/closure"][0]
    lines = code.replace('"atlas.nc"', repr(str(results / "atlas.nc"))).splitlines()
    names = {}
    exec("\n".join(lines[:-1]), names)
    assert eval(lines[-1], names) == value
    names["atlas"].close()
    assert xr is names["xr"]


#: Draws a plot of the page anew, along y from and to these numbers.
DRAWN_FROM_TO = """([low, high, log]) => {
  const points = [low, high].map((y, i) => ({ x: i + 1, y }));
  const rest = { series: [{ points }], dots: [], key: [] };
  const y = { label: "y (mm)", log };
  drawPlot(document.querySelector(".plot"), { x: { label: "x" }, y, ...rest });
}"""


@pytest.mark.parametrize("phone", [False, True])
def test_the_title_of_an_axis_stands_clear_of_its_numbers_however_wide(open_page, phone):
    with open_page("explorer.html", phone=phone) as page:
        page.wait_for_selector(DRAWN)
        for drawing in page.locator(".plot svg").all():
            assert_readable(drawing)
        for ends in ([100012, 100019, False], [-1.00012e-7, -1.00019e-7, False], [1e-12, 1, True]):
            page.evaluate(DRAWN_FROM_TO, ends)
            assert_readable(page.locator(".plot svg").first)
