"""Templates: untrusted text is shown, never run."""

import json

import pytest

from fractalcontact.pages.templating import environment, script_data, write_page

HOSTILE = "</script><script>alert(1)</script><img src=x onerror=alert(1)> & \u2028 'q' \"d\""


def test_texts_are_escaped(tmp_path):
    write_page(tmp_path / "a.html", "page.html", {"title": HOSTILE})
    text = (tmp_path / "a.html").read_text(encoding="utf-8")
    assert "<script>alert" not in text
    assert "<img" not in text
    assert "&lt;/script&gt;" in text


def test_data_of_a_script_end_no_element_and_come_back():
    data = script_data({"label": HOSTILE, "value": 0.1, "none": None})
    assert not set("<>&\u2028") & set(data)
    assert json.loads(data) == {"label": HOSTILE, "value": 0.1, "none": None}


def test_a_number_that_json_has_not_is_refused():
    with pytest.raises(ValueError, match="not JSON compliant"):
        script_data([float("nan")])


def test_a_value_that_is_missing_is_an_error():
    with pytest.raises(Exception, match="missing"):
        environment().from_string("{{ missing }}").render()
