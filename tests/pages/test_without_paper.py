"""Pages of a study without the paper: `figures: joint`."""

import json
import re
import shutil

import netCDF4
import pytest
from markupsafe import escape
from page_study import write_pages

from fractalcontact.core.subject import Subject
from fractalcontact.report.scan_words import warnings_of_specimen
from fractalcontact.study.atlas import read_atlas


@pytest.fixture(scope="module")
def without_paper(results, tmp_path_factory):
    """The study of the pages with `figures: joint`."""
    folder = tmp_path_factory.mktemp("joint") / "results/tiny"
    shutil.copytree(results, folder)
    with netCDF4.Dataset(folder / "atlas.nc", "a") as file:
        configuration = json.loads(file.configuration)
        configuration["study"]["figures"] = "joint"
        file.configuration = json.dumps(configuration)
    write_pages(folder)
    return folder


def test_a_joint_s_page_links_to_the_statements_and_lists_none(results, without_paper):
    whole, page = (
        (folder / "pages/pair.html").read_text(encoding="utf-8")
        for folder in (results, without_paper)
    )
    assert 'id="statement-' in whole
    assert 'id="statement-' not in page
    assert 'href="../index.html#statements"' in page
    assert 'href="#statements"' not in page


def test_the_index_folds_the_statements_and_keeps_their_table(results, without_paper):
    whole, index = (
        (folder / "index.html").read_text(encoding="utf-8") for folder in (results, without_paper)
    )
    assert '<h2 id="statements">' in whole
    assert index.count('<details id="statements">') == 1
    folded = index.partition('<details id="statements">')[2].partition('<h2 id="study">')[0]
    assert folded.count("</details>") >= 1
    opens = re.compile(r'data-opens="([^"]*)"')
    assert opens.findall(folded) == opens.findall(whole)
    assert "#statement-" not in index


def test_a_scanned_joint_has_its_picture_on_the_first_screen(results):
    index = (results / "index.html").read_text(encoding="utf-8")
    block = index.partition('id="joint-pair"')[2].partition("</article>")[0]
    (picture,) = re.findall(r'<img class="overview"[^>]*>', block)
    assert 'src="figures/pair/overview.png" width="3" height="2"' in picture


def test_the_index_lists_figures_of_the_paper_with_their_joints(results, without_paper):
    index = (results / "index.html").read_text(encoding="utf-8")
    table = index.partition('<h2 id="paper">')[2].partition("</table>")[0]
    rows = re.findall(r"<tr><td class=\"number\">(.*?)</td><td>.*?</td><td>(.*?)</td></tr>", table)
    numbers = [number for number, _ in rows]
    assert {"Fig. 8", "Figs. 4 and 5", "Fig. 13"} <= set(numbers)
    assert all(number.startswith("Fig") for number in numbers)
    links = dict(rows)["Fig. 8"]
    assert re.findall(r'href="([^"]*)"', links) == [
        f"pages/{name}.html#figure-fig08_prefractals" for name in ("flat.1", "pair")
    ]
    assert 'id="paper"' not in (without_paper / "index.html").read_text(encoding="utf-8")


def test_a_page_repeats_each_warning_of_the_check_of_scans(results):
    page = (results / "pages/pair.html").read_text(encoding="utf-8")
    atlas = read_atlas(results / "atlas.nc")
    subject = Subject.of(atlas, "pair")
    warnings = warnings_of_specimen(subject["specimens"], subject["quality"])
    listed = page.partition('<div id="warnings">')[2].partition("</div>")[0]
    others = [one for one in warnings if one != subject["quality"].attrs["warning"]]
    assert others
    assert listed.count("<li>") == len(others)
    for warning in others:
        assert str(escape(warning))[1:60] in listed
