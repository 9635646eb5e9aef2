"""The text of a sidecar: plain words and numbers, one clear error for anything else."""

import time

import pytest
import yaml
from places import ROOT

from fractalcontact.core.errors import InputError
from fractalcontact.study.checks import read_sidecar
from fractalcontact.study.sidecar import LARGEST_SIDECAR, read_yaml

SCHEMA = yaml.safe_load((ROOT / "config/schema/study.schema.yaml").read_text())


@pytest.fixture
def sidecar(tmp_path):
    def write(content):
        path = tmp_path / "rock.yaml"
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return write


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("0.1 mm", "0.1 mm"),
        ("1e-3", 1e-3),
        ("-9999", -9999),
        ("010", 10),
        ("3.", 3.0),
        ("1:30", "1:30"),
        ("2020-01-01", "2020-01-01"),
        ("no", "no"),
        ("true", True),
        ("~", None),
        ("", None),
        ("'7'", "7"),
        ("[a, 0.5, {b: c}]", ["a", 0.5, {"b": "c"}]),
        ("9" * 5000, float("inf")),
        ("-.inf", -float("inf")),
    ],
)
def test_values_are_what_they_look_like(sidecar, text, value):
    assert read_yaml(sidecar(f"key: {text}\n")) == {"key": value}


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_encodings_that_editors_write(sidecar, encoding):
    assert read_yaml(sidecar("unit: µm\n".encode(encoding))) == {"unit": "µm"}


def test_keys_are_the_texts_that_stand_there(sidecar):
    assert read_yaml(sidecar("no: 1\n1: on\n'yes': 2\n~: 3\n")) == {
        "no": 1,
        "1": "on",
        "yes": 2,
        "~": 3,
    }


def test_an_empty_sidecar_says_nothing(sidecar):
    assert read_yaml(sidecar("")) == read_yaml(sidecar("# unit: mm\n")) == {}


LAUGHS = "a: &a [x, x]\nb: &b [*a, *a]\nc: &c [*b, *b]\nd: [*c, *c]\n"


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (LAUGHS, "line 1: anchors"),
        ("unit: *mm\n", "line 1: anchors"),
        ("unit: " + "[" * 60_000, "nested more than"),
        ("unit: mm\n" + "- " * 20_000, "not readable as YAML"),
        ("unit: mm\n" * 2, "line 2: the key 'unit' stands here a second time, after line 1; keep"),
        ("upper:\n  unit: m\n  unit: mm\n", "line 3: the key 'unit' .* after line 2"),
        ("unit: mm\n" * 10_000, "longer than the 64 kB"),
        ("? [a, b]\n: mm\n", "is no word"),
        ("unit: !!python/object/apply:os.system [ls]\n", "has no use here"),
        ("unit: !!binary aGk=\n", "has no use here"),
        ("unit: mm\n---\nunit: m\n", "not readable as YAML"),
        ("unit: mm\n\tspacing: 1\n", "line 2"),
        ("- mm\n", "expected 'key: value' lines, found list"),
        (b"unit: \xb5m\n", "not readable as YAML: .*UTF-8"),
        (b"unit: m\x00m\n", "not readable as YAML"),
        (b"\x00" * 100, "not readable as YAML"),
    ],
)
def test_what_is_no_sidecar_is_one_short_error(sidecar, content, message):
    start = time.monotonic()
    with pytest.raises(InputError, match=rf"rock\.yaml: .*{message}") as error:
        read_yaml(sidecar(content))
    assert time.monotonic() - start < 3
    assert len(str(error.value)) < 400
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("spacing: .nan\nfoo: 1\n", "unknown key 'foo'"),
        ("label: " + "x" * 5000, "label: 'xxx.*is not right; expected what it is, in up to 200"),
        ("label: cost $a$\n", "label"),
        ('label: "\\e[31m"\n', "label"),
        ("k" * 900 + ": 1\n", "unknown key 'kkk.*known"),
        ("layout: [" + "9, " * 5000 + "9]\n", "layout: .* is not right; expected matrix or points"),
    ],
)
def test_values_of_any_length_make_short_errors(sidecar, content, message):
    with pytest.raises(InputError, match=rf"rock\.yaml: .*{message}") as error:
        read_sidecar(sidecar(content), SCHEMA)
    assert len(str(error.value)) < 1000
    assert str(error.value).isprintable()


def test_the_largest_sidecar_is_read_whole(sidecar):
    keys = "".join(f"key{n}: [1, 2, 3]\n" for n in range(3000))
    assert len(read_yaml(sidecar(keys[:LARGEST_SIDECAR].rsplit("\n", 1)[0]))) > 2000
