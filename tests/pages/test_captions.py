"""Captions in their parts, and symbols as printed."""

import pytest

from fractalcontact.pages.captions import symbols, take_apart

LABEL = "Dr. Who's joint. 2.1 (A_r) <b>bold</b>"


def test_a_caption_in_parts_is_read_as_it_stands():
    """No sentence is sought in it: its heading keeps its numbers, its lines their labels."""
    heading, shown, *found = (
        "It rises by 3.1 [2, 4].",
        f"{LABEL}. (a) Closure.",
        "One. Two.",
        "End.",
    )
    parts = take_apart("\n".join([heading, "", shown, *found]) + "\n")
    assert (parts.finding, parts.text, parts.rest) == (heading, [shown], found)
    assert take_apart(f"\n\n{shown}\n").finding == ""


def test_nothing_found_is_no_heading():
    assert take_apart("Supplementary figure. Curves of a joint.").finding == ""
    assert take_apart("").text == []
    assert take_apart("Not drawn: a figure, because of an error.").text == [
        "Not drawn: a figure, because of an error."
    ]


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
