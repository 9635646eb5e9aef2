"""What the documentation says can be run: examples, scripts, commands."""

import os
import re
import runpy
import subprocess
import sys
from importlib.util import find_spec

import numpy as np
import pytest
from places import ROOT

import fractalcontact

DOCS = ROOT / "docs"
GALLERY = DOCS / "gallery"


def examples(page):
    """Python blocks of a page, as one program."""
    blocks = re.findall(
        r"^```python\n(.+?)^```$", (DOCS / page).read_text(), re.MULTILINE | re.DOTALL
    )
    assert blocks
    return "\n".join(blocks)


def test_examples_of_the_library_run_and_find_what_was_put_in(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    names = {}
    exec(compile(examples("library.md"), "library.md", "exec"), names)
    assert names["face"].shape == (96, 96)
    np.testing.assert_allclose(names["face"].values, names["heights"], atol=1e-12)
    assert names["low"] < 2.2 < names["high"]
    law = names["law"]
    assert 0 < law.k_ni.low < law.k_ni.value < law.k_ni.high
    assert law.n == 6
    assert names["state"].force == pytest.approx(40 * 9.6**2, rel=1e-6)
    assert names["dimension"].low <= names["dimension"].dimension <= names["dimension"].high
    used = set(re.findall(r"\b\w+\b", (DOCS / "library.md").read_text()))
    functions = [name for name in fractalcontact.__all__ if name[0].islower()]
    assert set(functions) <= used


def test_hertz_of_the_gallery_is_close_and_the_rough_faces_close():
    errors = runpy.run_path(str(GALLERY / "hertz.py"))["main"]()
    assert max(map(abs, errors.values())) < 1e-3
    hyperbola, dimension = runpy.run_path(str(GALLERY / "rough_faces.py"))["main"]()
    assert 0 < hyperbola.k_ni.low < hyperbola.k_ni.value
    assert 0 < dimension.dimension < 2


def test_every_script_of_the_gallery_is_on_its_page():
    text = (DOCS / "gallery.md").read_text()
    for path in GALLERY.glob("*.py"):
        assert f"{{literalinclude}} gallery/{path.name}" in text
        assert f".venv/bin/python docs/gallery/{path.name}" in text


def test_every_command_of_the_verification_table_selects_a_test():
    commands = re.findall(r"`(tests/\S+\.py) -k (\w+)`", (DOCS / "verification.md").read_text())
    assert len(commands) > 20
    for path, word in commands:
        names = re.findall(r"^def (test_\w+)", (ROOT / path).read_text(), re.MULTILINE)
        assert any(word in name for name in names), (path, word)


def test_pictures_are_small_and_every_page_is_in_the_contents():
    pictures = [*DOCS.glob("*.png")]
    assert pictures
    assert [path.name for path in pictures if path.stat().st_size > 200_000] == []
    trees = re.findall(r"^```\{toctree\}\n(.+?)^```$", (DOCS / "index.md").read_text(), re.M | re.S)
    listed = {line for tree in trees for line in tree.splitlines() if line and line[0] != ":"}
    assert listed == {path.stem for path in DOCS.glob("*.md")} - {"index"}


def test_every_function_of_the_package_is_in_the_reference():
    text = (DOCS / "api.md").read_text()
    assert set(fractalcontact.__all__) == set(re.findall(r"auto\w+:: fractalcontact\.(\w+)", text))


@pytest.mark.full
@pytest.mark.skipif(find_spec("sphinx") is None, reason="`make docs` installs Sphinx")
@pytest.mark.parametrize("link", ["[to](no_such_page.md)", "[to](atlas.md#no-such-heading)"])
def test_a_broken_link_fails_the_build(tmp_path, link):
    for name in ("conf.py", "atlas.md"):
        (tmp_path / name).write_text((DOCS / name).read_text())
    (tmp_path / "index.md").write_text(f"# Start\n\n{link}\n\n```{{toctree}}\natlas\n```\n")
    command = [
        sys.executable,
        "-m",
        "sphinx",
        "-W",
        "-q",
        "-b",
        "html",
        tmp_path,
        tmp_path / "site",
    ]
    paths = {"PYTHONPATH": str(ROOT / "src"), **os.environ}
    done = subprocess.run(command, capture_output=True, text=True, env=paths)
    assert done.returncode != 0
    assert "no" in done.stderr
    assert "such" in done.stderr
