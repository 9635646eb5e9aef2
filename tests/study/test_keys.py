"""Keys are typed once: what is made from them is up to date, and errors say what to write."""

import copy
import json

import pytest
import yaml
from places import ROOT

from fractalcontact.commands.write_keys import schemas, tables, written
from fractalcontact.core.errors import InputError
from fractalcontact.core.keys import Section, schema_of, texts_of
from fractalcontact.study.checks import check_study, read_sidecar
from fractalcontact.study.documents import read_study
from fractalcontact.study.keys import SettingsKeys, SidecarKeys

#: What is wrong ("set" in config/paper.yaml, or the whole text), and the words for it; "before"
#: those of version 1.0.0, where they differ.
WRONG = yaml.safe_load((ROOT / "tests/study/wrong_inputs.yaml").read_text())
PAPER = (ROOT / "config/paper.yaml").read_text()


def test_schemas_are_those_of_the_classes():
    texts = schemas()
    assert texts.keys() == {f"config/schema/{of}.schema.json" for of in ("study", "sidecar")}
    for path, text in texts.items():
        assert (ROOT / path).read_text(encoding="utf-8") == text, "make schema"


def test_tables_of_keys_are_those_of_the_classes():
    documents = tables()
    assert len(documents) > 1
    for path, of_document in documents.items():
        document = (ROOT / path).read_text(encoding="utf-8")
        assert document == written(document, of_document), f"{path}: make schema"


def test_no_cell_of_a_table_of_keys_is_long():
    rows = [
        line for line in (ROOT / "docs/keys.md").read_text().splitlines() if line.startswith("| `")
    ]
    assert len(rows) > 100
    assert [cell for row in rows for cell in row.split(" | ") if len(cell.split()) > 40] == []


class Lower(Section):
    """A section of two keys."""

    a: int = 0
    """text of a,
    in two lines"""
    b: int = 0
    """text of b"""
    c: int = 0


class Upper(Lower):
    b: int = 1
    """another text of b"""


def test_the_text_below_a_key_is_its_own_or_that_of_a_base():
    assert texts_of(Lower) == {"a": "text of a, in two lines", "b": "text of b"}
    assert texts_of(Upper) == {"a": "text of a, in two lines", "b": "another text of b"}
    assert {"window", "material"} <= texts_of(SettingsKeys).keys()  # made from another class
    schema = schema_of(Upper, with_texts=True)["properties"]
    assert schema["b"]["markdownDescription"] == "another text of b"
    assert "markdownDescription" not in schema_of(Upper)["properties"]["b"]


def changed(document, keys, value):
    """A document with one value set, or one key taken out."""
    *parents, last = keys
    inner = document
    for key in parents:
        inner = inner.setdefault(key, {})
    inner[last] = value
    if value == "(left out)":
        del inner[last]
    return document


def named(case):
    return json.dumps(case.get("set", case.get("text")))


@pytest.mark.parametrize("case", WRONG, ids=named)
def test_each_wrong_input_gets_its_words(tmp_path, case):
    path = tmp_path / f"{'rock' if case['of'] == 'sidecar' else 'mine'}.yaml"
    if "set" in case:
        document = yaml.safe_load(PAPER)
        for keys, value in case["set"]:
            document = changed(copy.deepcopy(document), keys, value)
        path.write_text(yaml.safe_dump(document, sort_keys=False))
    else:
        path.write_text(case["text"])
    with pytest.raises(InputError) as error:
        read_sidecar(path) if case["of"] == "sidecar" else check_study(read_study(path), str(path))
    words = case["words"].replace("KEYS OF A SIDECAR", ", ".join(SidecarKeys.model_fields))
    assert str(error.value).replace(f"{tmp_path}/", "") == words
