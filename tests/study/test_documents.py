"""The file of a study: each key once, words as they stand there."""

import pytest
from places import ROOT

from fractalcontact.core.errors import InputError
from fractalcontact.study.documents import read_study


@pytest.fixture
def written(tmp_path):
    def write(text):
        path = tmp_path / "mine.yaml"
        path.write_text(text)
        return path

    return write


@pytest.mark.parametrize(
    ("text", "key", "first", "second"),
    [
        ("study: a\nscans: null\nstudy: b\n", "study", 1, 3),
        ("defaults: {window: 5 mm, window: 50 mm}\n", "window", 1, 1),
        ("materials:\n  rock: {modulus: 1 GPa}\n  rock: {modulus: 9 GPa}\n", "rock", 2, 3),
        ("specimens:\n  a:\n    measured:\n      closure: [{cycle: 1, cycle: 2}]\n", "cycle", 4, 4),
        ("embedded:\n  a: &a {rms: 1 mm}\n  b:\n    <<: *a\n    <<: *a\n", "<<", 4, 5),
    ],
)
def test_a_key_that_stands_twice_is_refused_with_both_lines(written, text, key, first, second):
    message = rf"mine\.yaml: .*line {second}: the key '{key}' .* after line {first}; keep one"
    with pytest.raises(InputError, match=message):
        read_study(written(text))


def test_a_merged_mapping_may_be_overridden(written):
    text = "embedded:\n  a: &a {rms: 1 mm, seed: 1}\n  b: {<<: *a, seed: 2}\n"
    assert read_study(written(text))["embedded"]["b"] == {"rms": "1 mm", "seed": 2}


def test_words_numbers_and_names_are_what_they_look_like(written):
    text = "specimens: {no: {label: on}, 12: {label: yes}, 1e3: {}}\nsolver: {rtol: 1e-6}\n"
    read = read_study(written(text))
    assert read["specimens"] == {"no": {"label": "on"}, "12": {"label": "yes"}, "1e3": {}}
    assert read["solver"]["rtol"] == 1e-6


@pytest.mark.parametrize("path", sorted((ROOT / "config").glob("**/*.yaml")), ids=lambda p: p.name)
def test_every_file_of_the_project_is_read(path):
    assert read_study(path)
