"""Which specimen and which face a file is of, by its name alone."""

import pytest

from fractalcontact.core.file_names import specimen_name, split_file_name


@pytest.mark.parametrize(
    ("file_name", "name", "role"),
    [
        ("granite.x3p", "granite", "only"),
        ("granite.lower.xyz", "granite", "lower"),
        ("granite.UPPER.XYZ", "granite", "upper"),
        ("granite.v2.csv", "granite.v2", "only"),
        ("granite.yaml", "granite", "sidecar"),
        ("granite.YML", "granite", "sidecar"),
        ("lower.xyz", "lower", "only"),
    ],
)
def test_the_last_words_of_a_name_say_the_role(file_name, name, role):
    assert split_file_name(file_name) == (name, role)


@pytest.mark.parametrize(
    ("original", "name"),
    [
        ("granite-1_a.b", "granite-1_a.b"),
        ("a b/c", "a_b_c"),
        ("-rf", "rf"),
        ("..hidden", "hidden"),
        ("con", "_con"),
        ("Aux.1", "_Aux.1"),
        ("contact", "contact"),
    ],
)
def test_names_become_safe(original, name):
    assert specimen_name(original) == name


def test_accents_that_look_the_same_are_the_same():
    assert specimen_name("gre\u0301s") == specimen_name("gr\u00e9s") == "gr_s"


def test_long_names_in_other_alphabets_stay_apart():
    first, second = (specimen_name(letter * 24) for letter in "花岗")
    assert first.startswith("_" * 24 + "-")
    assert first != second
