"""The result page in a real browser: table, curves, statements and links."""

import re
import time
from urllib.parse import unquote

import numpy as np
import pandas as pd
import pytest
from page_drawings import assert_readable

pytestmark = [pytest.mark.browser, pytest.mark.workflow]
#: Addresses of a page, those inside its templates too, and what stands in it to be linked to.
LINKS = """() => {
  const parts = [document, ...[...document.querySelectorAll("template")].map((t) => t.content)];
  return parts.flatMap((part) => [...part.querySelectorAll("[href], [src]")]
    .map((one) => one.getAttribute("href") || one.getAttribute("src")));
}"""
IDS = "() => [...document.querySelectorAll('[id]')].map((one) => one.id)"
SHOWN = "td:nth-child({column}) [data-load={load}]"


@pytest.fixture(scope="module")
def pages(results):
    """Names of the pages of the study, from the folder of the results."""
    specimens = sorted(path.name for path in (results / "pages").glob("*.html"))
    assert specimens
    return ["index.html", *(f"pages/{name}" for name in specimens)]


def rows_of(page):
    return page.locator("#table tbody tr")


def names_of(page):
    return page.locator("#table .pick").evaluate_all("boxes => boxes.map((box) => box.value)")


def test_opens_from_the_disk(open_page, results, report, shots):
    begin = time.perf_counter()
    with open_page("index.html") as page:
        page.wait_for_selector("#chart svg")
        seconds = time.perf_counter() - begin
        page.screenshot(path=shots / "index_desktop.png", full_page=True)
    size = (results / "index.html").stat().st_size
    report.append(f"index.html: {size / 1e6:.2f} MB, drawn after {seconds:.2f} s")


def test_every_link_leads_somewhere(open_page, results, pages):
    linked, ids = {}, {}
    for name in pages:
        with open_page(name) as page:
            linked[name], ids[name] = page.evaluate(LINKS), set(page.evaluate(IDS))
    assert sum(map(len, linked.values())) > 50
    for name, addresses in linked.items():
        for address in addresses:
            if address.startswith("data:"):
                continue
            path, _, place = address.partition("#")
            target = ((results / name).parent / unquote(path)).resolve() if path else results / name
            assert target.is_relative_to(results.resolve()), (name, address)
            assert target.is_file(), (name, address)
            known = ids.get(str(target.relative_to(results.resolve())) if path else name)
            if place and known is not None:
                assert unquote(place) in known, (name, address)


def test_a_click_on_a_heading_sorts_the_rows_both_ways(open_page):
    with open_page("index.html") as page:
        assert page.locator("#table thead th:visible").count() == 9
        page.locator("#all-columns").check()
        headings = page.locator("#table thead button")
        assert page.locator("#table thead th:visible").count() == headings.count() == 17
        for i in range(headings.count()):
            if i == 1:  # lights: how many are good
                continue
            orders = []
            for direction in ("ascending", "descending"):
                headings.nth(i).click()
                heading = page.locator("#table thead th").nth(i)
                assert heading.get_attribute("aria-sort") == direction
                shown = page.evaluate(
                    """i => [...document.querySelectorAll("#table tbody tr")].map((row) => {
                      const cell = row.cells[i];
                      const load = document.getElementById("table").dataset.load;
                      const one = cell.querySelector(`[data-load=${load}]`) || cell;
                      return one.dataset.sort ?? one.textContent.trim();
                    })""",
                    i,
                )
                orders.append([text for text in shown if text != ""])
                # What is missing stands last.
                assert shown == orders[-1] + [""] * (len(shown) - len(orders[-1]))
            if all(_is_number(text) for text in orders[0]):
                orders = [[float(text) for text in order] for order in orders]
            assert orders[0] == sorted(orders[0]), headings.nth(i).text_content()
            assert orders[1] == sorted(orders[1], reverse=True)


def _is_number(text):
    try:
        float(text)
    except ValueError:
        return False
    return True


def test_the_table_shows_the_atlas_under_the_chosen_pressure(open_page, atlas):
    """All rows at one nominal pressure, within 5 %; blank where a specimen was not solved there."""
    compared = 0
    with open_page("index.html") as page:
        choice = page.locator("#load")
        keys = choice.locator("option").evaluate_all("all => all.map((one) => one.value)")
        assert keys
        for key in keys:
            choice.select_option(key)
            pressures = []
            for row, name in zip(rows_of(page).all(), names_of(page), strict=True):
                shown = {
                    column: row.locator(SHOWN.format(column=column, load=key))
                    for column in (6, 7, 8, 9, 11, 17)
                }
                assert all(cell.get_attribute("hidden") is None for cell in shown.values())
                sorts = {i: cell.get_attribute("data-sort") for i, cell in shown.items()}
                if not sorts[6]:
                    assert set(sorts.values()) == {""}
                    continue
                pressures.append(float(sorts[6]))
                at, curves = _states_at(atlas, name, pressures[-1])
                for column, variable in (
                    (8, "seated_closure"),
                    (9, "interface_closure"),
                    (11, "interface_stiffness"),
                    (17, "nodes"),
                ):
                    if sorts[column]:
                        expected = float(curves[variable].values[at])
                        assert float(sorts[column]) == pytest.approx(expected)
                        compared += 1
                # F = A_r sigma_n of the corrected area, and none where too few nodes touch for it.
                assert bool(sorts[7]) == bool(curves["area_corrected_resolved"].values[at])
                if sorts[7]:
                    force, area = (curves[n].values[at] for n in ("normal_force", "area_corrected"))
                    assert force / float(area) == pytest.approx(float(sorts[7]))
            assert max(pressures) <= 1.1 * min(pressures)
    assert compared > 5


def _states_at(atlas, name, pressure):
    """Curves of the states of the contact maps, and the number of the load at this pressure."""
    contact = atlas[f"contact/{name}"].attrs
    curves = atlas[f"closure/{name}"].to_dataset()
    curves = curves.sel(
        direction=contact["map_direction"],
        offset=contact["map_offset"],
        resolution=contact["map_resolution"],
    )
    at = int(np.abs(curves["nominal_pressure"].values - pressure).argmin())
    assert curves["nominal_pressure"].values[at] == pytest.approx(pressure)
    return at, curves


def test_every_specimen_has_five_lights_with_their_reasons(open_page, pages):
    with open_page("index.html") as page:
        for row in rows_of(page).all():
            lights = row.locator(".lights li")
            assert lights.count() == 5
            for light in lights.all():
                assert light.get_attribute("title")
                assert light.text_content().split(":")[1].strip()
    with open_page(pages[1]) as page:
        assert page.locator(".lights.long li").count() == 5


def test_ticked_specimens_lie_over_each_other_and_over_another_study(
    open_page, results, tmp_path, shots
):
    with open_page("index.html") as page:
        boxes, curves = page.locator(".pick"), page.locator("#chart g.curve")
        for box in boxes.all():
            box.uncheck()
        assert curves.count() == 0
        assert "Tick a specimen" in page.locator("#chart").text_content()
        for n, box in enumerate(boxes.all(), start=1):
            box.check()
            assert curves.count() == n == page.locator("#legend li").count()
        for quantity in page.locator("#quantity option").all():
            page.locator("#quantity").select_option(quantity.get_attribute("value"))
            assert page.locator("#chart").text_content()
            if page.locator("#chart svg").count():
                assert_readable(page.locator("#chart svg"))
        page.locator("#quantity").select_option(index=0)
        table = pd.read_csv(results / "curves.csv").assign(study="another")
        table.to_csv(tmp_path / "curves.csv", index=False)
        before = curves.count()
        page.locator("#other").set_input_files(tmp_path / "curves.csv")
        page.wait_for_selector("#other-said:has-text('another')")
        assert curves.count() == 2 * before
        assert "other file" in page.locator("#legend").text_content()
        page.locator("#chart").screenshot(path=shots / "index_overlay.png")
        # Numbers between which an axis needs many digits.
        table["value"] = np.linspace(-100019, -100012, len(table))
        table.assign(low=np.nan, high=np.nan).to_csv(tmp_path / "wide.csv", index=False)
        for box in boxes.all():
            box.uncheck()
        page.locator("#other").set_input_files(tmp_path / "wide.csv")
        page.wait_for_selector("#chart svg")
        assert_readable(page.locator("#chart svg"))
        for box in boxes.all():
            box.check()
        (tmp_path / "wrong.csv").write_text("a,b\n1,2\n")
        page.locator("#other").set_input_files(tmp_path / "wrong.csv")
        page.wait_for_selector("#other-said:has-text('no column')")
        assert curves.count() == before


def test_the_curves_are_those_of_the_atlas(results, atlas):
    table = pd.read_csv(results / "curves.csv")
    compared = 0
    for name, rows in table[table["quantity"].str.contains("first touch")].groupby("specimen"):
        contact = atlas[f"contact/{name}"].attrs
        curve = atlas[f"closure/{name}/interface_closure"].sel(
            direction=contact["map_direction"],
            offset=contact["map_offset"],
            resolution=contact["map_resolution"],
        )
        for row in rows.itertuples():
            at = np.abs(curve["nominal_pressure"].values - row.nominal_pressure_MPa).argmin()
            assert row.value == pytest.approx(float(curve.values[at]), rel=1e-6)
            compared += 1
    assert compared > 5


def test_a_verdict_opens_its_rule_and_a_key_closes_it(open_page, shots):
    with open_page("index.html") as page:
        link = page.locator(".matrix [data-opens]").first
        link.click()
        opened = page.locator("#opened")
        assert opened.is_visible()
        assert "Rule" in opened.text_content()
        page.screenshot(path=shots / "index_statement.png")
        page.keyboard.press("Escape")
        assert opened.is_hidden()


def test_numbers_of_a_figure_fold_out_and_its_pictures_are_there(open_page, pages, shots):
    with open_page(pages[1]) as page:
        folded = page.locator(".card details").first
        inside = folded.locator(":scope > :not(summary)").first
        assert inside.is_hidden()
        folded.locator("summary").click()
        assert inside.is_visible()
        for picture in page.locator(".card img").all():
            picture.scroll_into_view_if_needed()
            picture.evaluate("one => one.decode()")
            assert picture.evaluate("one => one.naturalWidth") > 100
        page.screenshot(path=shots / "specimen_desktop.png", full_page=True)


def test_a_specimen_leads_to_its_states(open_page, results):
    with open_page("index.html") as page:
        link = page.locator("a", has_text="explore").last
        name = link.locator("xpath=ancestor::tr").locator(".pick").get_attribute("value")
        link.click()
        page.wait_for_selector("body[data-drawn]")
        chosen = page.locator("[data-state=a] .specimen option:checked").text_content()
        assert chosen.startswith(name)
        page.locator("header a", has_text="results").click()
        page.wait_for_selector("#table")


def test_the_table_of_specimens_is_whole_on_a_small_screen(open_page):
    with open_page("index.html") as page:
        page.set_viewport_size({"width": 1200, "height": 900})
        needed, there = page.locator("#table").evaluate("(e) => [e.scrollWidth, e.clientWidth]")
        assert needed <= there


@pytest.mark.parametrize("which", range(4))
def test_no_button_is_printed(open_page, results, pages, which):
    """Of the card of a specimen and the explorer too: paper has nothing to press."""
    card = f"cards/{pages[1].rpartition('/')[2]}"
    with open_page([*pages[:2], card, "explorer.html"][which]) as page:
        page.wait_for_load_state()
        page.emulate_media(media="print")
        shown = "all => all.filter((one) => one.checkVisibility()).map((one) => one.outerHTML)"
        pressed = "button:not(th button), .button, .choice label:not(:has(:checked))"
        assert page.locator(pressed).evaluate_all(shown) == []


@pytest.mark.parametrize("which", [0, 1])
def test_fits_a_phone(open_page, pages, shots, which):
    with open_page(pages[which], phone=True) as page:
        page.wait_for_load_state()
        scroll, width = page.evaluate("[document.documentElement.scrollWidth, innerWidth]")
        assert scroll <= width
        page.screenshot(path=shots / f"{'specimen' if which else 'index'}_phone.png")


def test_a_card_opens_from_the_first_screen_and_prints_on_one_page(open_page, results, shots):
    with open_page("index.html") as page:
        cards = page.locator(".joint a.first").evaluate_all("links => links.map((a) => a.href)")
        assert len(cards) == page.locator(".joint").count() == len(names_of(page)) > 0
    for address in cards:
        name = f"cards/{address.rpartition('/')[2]}"
        with open_page(name) as page:
            assert "Trust:" in page.locator("body").inner_text()
            printed = page.pdf(prefer_css_page_size=True)
            assert len(re.findall(rb"/Type\s*/Page[^s]", printed)) == 1, name
            page.screenshot(path=shots / "card_desktop.png", full_page=True)
        with open_page(name, phone=True) as page:
            scroll, width = page.evaluate("[document.documentElement.scrollWidth, innerWidth]")
            assert scroll <= width
