"""Captions taken apart: sentences, headings, symbols."""

import pytest

from fractalcontact.pages.captions import symbols, take_apart
from fractalcontact.pages.sentences import without_opening

LABEL = "Dr. Who's joint. 2.1 (A_r) <b>bold</b>"
CAPTION = (
    f"After Figs. 4 and 5 of Borri-Brunetto et al. (1999): {LABEL}, sliding towards West. "
    "(a) Closure, eq. 6, h = 0.3 mm; (b) area. The paper's plateau: holds (2 of 4 directions "
    "level; circular: the specimen was chosen for it). sigma_n reaches 18.2 GPa. "
    "Delta_g is 2.23 [2.18, 2.33]."
)


def test_sentences_end_where_they_end():
    """Neither at an abbreviation nor inside a label, whatever it holds."""
    found = take_apart(CAPTION, LABEL)
    assert found.text == [
        f"After Figs. 4 and 5 of Borri-Brunetto et al. (1999): {LABEL}, sliding towards West.",
        "(a) Closure, eq. 6, h = 0.3 mm; (b) area.",
    ]
    assert found.rest[1:] == ["sigma_n reaches 18.2 GPa.", "Delta_g is 2.23 [2.18, 2.33]."]


def test_no_word_of_a_caption_is_lost():
    found = take_apart(CAPTION, LABEL)
    assert " ".join([*found.text, *found.rest]) == CAPTION


def test_heading_has_no_brackets_of_numbers_and_stays_circular():
    assert take_apart(CAPTION, LABEL).finding == "The paper's plateau: holds (circular)."
    text = "After Fig. 2 of X (1999): a. Relief. Delta_g is 2.23 [2.18, 2.33] by A_r(s) (7 of 8)."
    assert take_apart(text).finding == "Delta_g is 2.23 by A_r(s)."


@pytest.mark.parametrize("joined", [True, False])
def test_warnings_that_the_page_states_are_left_out(joined):
    warnings = ["noise. At 2 mm", "load on spikes"]
    said = [f"WARNING: {'; '.join(warnings)}."] if joined else [f"WARNING: {w}." for w in warnings]
    assert take_apart(" ".join([CAPTION, *said]), LABEL, warnings) == take_apart(CAPTION, LABEL)


def test_a_table_is_headed_by_its_count():
    found = take_apart("After the statements of X (1999): a joint. Of 27 statements 12 hold. Ours.")
    assert found.finding == "Of 27 statements 12 hold."


def test_a_caption_in_parts_is_read_as_it_stands():
    """No sentence is sought in it: its heading keeps its numbers, its lines their labels."""
    heading, shown, *found = (
        "It rises by 3.1 [2, 4].",
        f"{LABEL}. (a) Closure.",
        "One. Two.",
        "End.",
    )
    parts = take_apart("\n".join([heading, "", shown, *found]) + "\n", LABEL)
    assert (parts.finding, parts.text, parts.rest) == (heading, [shown], found)
    assert take_apart(f"\n\n{shown}\n").finding == ""


def test_nothing_found_is_no_heading():
    assert take_apart("Supplementary figure. Curves of a joint.").finding == ""
    assert take_apart("").text == []
    assert without_opening("Supplementary figure: a joint.") == "A joint."
    assert without_opening("w_int ~ b^e") == "w_int ~ b^e"


@pytest.mark.parametrize(
    ("text", "html"),
    [
        ("Delta_sigma", "Δ<sub>σ</sub>"),
        ("A_r/A_0 ~ b^e", "A<sub>r</sub>/A<sub>0</sub> ~ b<sup>e</sup>"),
        ("k_ni in 3 mm2", "k<sub>ni</sub> in 3 mm²"),
        ("h'_rms, delta_r", "h′<sub>rms</sub>, δ<sub>r</sub>"),
        ("sandstone_capped, small_twin", "sandstone_capped, small_twin"),
        ("b^-(2 - Delta_sigma)", "b<sup>-(2 - Δ<sub>σ</sub>)</sup>"),
        ("<i>A_r</i> & 'x'", "&lt;i&gt;A<sub>r</sub>&lt;/i&gt; &amp; &#39;x&#39;"),
    ],
)
def test_symbols_are_printed_as_such_and_nothing_else_is_html(text, html):
    assert symbols(text) == html
