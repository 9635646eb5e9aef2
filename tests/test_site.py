"""What the documentation says can be run: examples, scripts, commands."""

import os
import re
import runpy
import subprocess
import sys
from importlib.util import find_spec

import code_blocks
import numpy as np
import pytest
from code_blocks import DOCUMENTS, NOT_RUN, blocks, run_code, runs
from places import ROOT

import fractalcontact
from fractalcontact.surface.synthesis import self_affine

DOCS = ROOT / "docs"
GALLERY = DOCS / "gallery"


def test_every_code_block_is_run_or_says_why_not():
    run = runs()
    every = [block for path in DOCUMENTS for block in blocks(path.relative_to(ROOT).as_posix())]
    assert len(every) > 60
    left = [
        f"{block.document}, {block.heading}: {block.text[:50]!r}"
        for block in every
        if not block.why_not_run
        and not {(block.document, block.heading), (block.document, None)} & run
    ]
    assert left == []
    for document, words in NOT_RUN:
        named = [b for b in every if b.document == document and b.text.startswith(words)]
        assert named, f"{document} has no block that begins with {words!r}"


def test_a_block_that_no_test_runs_is_found(tmp_path, monkeypatch):
    (tmp_path / "page.md").write_text(
        "# One\n\n    x = 1\n\n\n    y = 2\n\n```python\nz = 3\n```\n"
    )
    monkeypatch.setattr(code_blocks, "ROOT", tmp_path)
    assert [(b.heading, b.text) for b in blocks("page.md")] == [
        ("One", "x = 1\n\n\ny = 2\n"),
        ("One", "z = 3\n"),
    ]
    assert not any(block.why_not_run for block in blocks("page.md"))


def test_examples_of_the_library_run_and_find_what_was_put_in(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    names = run_code("docs/library.md")
    assert names["face"].shape == (96, 96)
    np.testing.assert_allclose(names["face"].values, names["heights"], atol=1e-12)
    assert names["low"] < 2.2 < names["high"]
    law = names["law"]
    assert 0 < law.k_ni.low < law.k_ni.value < law.k_ni.high
    assert law.n == 6
    state, composite = names["state"], names["composite"]
    assert state.force == pytest.approx(40 * np.prod(names["sides"]), rel=1e-6)
    # Of two scanned faces: the gap is upper less lower, and the composite is that upside down.
    gap = names["upper"] - names["lower"]
    assert float(gap.mean()) == pytest.approx(0.3, abs=1e-6)
    np.testing.assert_array_equal(composite, -gap)
    # The mean gap is that of first touch, less the closure, and what the bulk gives way.
    touch = composite.max() - composite.mean()
    assert state.gap.mean() == pytest.approx(
        touch - state.closure + state.displacement.mean(), rel=1e-6
    )
    assert names["dimension"].low <= names["dimension"].dimension <= names["dimension"].high
    used = set(re.findall(r"\b\w+\b", (DOCS / "library.md").read_text(encoding="utf-8")))
    functions = [name for name in fractalcontact.__all__ if name[0].islower()]
    assert set(functions) <= used


def test_the_library_in_the_readme_presses_a_surface():
    heights = self_affine((32, 40), 0.1, 0.8, rms=0.05, seed=1)
    names = run_code(
        "README.md",
        "As a library",
        ny=32,
        nx=40,
        dy=0.1,
        dx=0.1,
        e_star=20e3,
        composite=heights,
    )
    assert names["state"].force == pytest.approx(11e3)
    assert names["state"].pressure.max() <= 2e3 * (1 + 1e-9)


def test_hertz_of_the_gallery_is_close_and_the_rough_faces_close():
    errors = runpy.run_path(str(GALLERY / "hertz.py"))["main"]()
    assert max(map(abs, errors.values())) < 1e-3
    hyperbola, dimension = runpy.run_path(str(GALLERY / "rough_faces.py"))["main"]()
    assert 0 < hyperbola.k_ni.low < hyperbola.k_ni.value
    assert 0 < dimension.dimension < 2


def test_every_script_of_the_gallery_is_on_its_page():
    text = (DOCS / "gallery.md").read_text(encoding="utf-8")
    for path in GALLERY.glob("*.py"):
        assert f"{{literalinclude}} gallery/{path.name}" in text
        assert f".venv/bin/python docs/gallery/{path.name}" in text


def test_every_command_of_the_verification_table_selects_a_test():
    commands = re.findall(
        r"`(tests/\S+\.py) -k (\w+)`", (DOCS / "verification.md").read_text(encoding="utf-8")
    )
    assert len(commands) > 20
    for path, word in commands:
        names = re.findall(
            r"^def (test_\w+)", (ROOT / path).read_text(encoding="utf-8"), re.MULTILINE
        )
        assert any(word in name for name in names), (path, word)


def test_pictures_are_small_and_every_page_is_in_the_contents():
    pictures = [*DOCS.glob("*.png")]
    assert pictures
    assert [path.name for path in pictures if path.stat().st_size > 200_000] == []
    trees = re.findall(
        r"^```\{toctree\}\n(.+?)^```$", (DOCS / "index.md").read_text(encoding="utf-8"), re.M | re.S
    )
    listed = {line for tree in trees for line in tree.splitlines() if line and line[0] != ":"}
    pages = [*DOCS.glob("*.md"), *DOCS.glob("notebooks/*.ipynb")]
    assert listed == {str(path.relative_to(DOCS).with_suffix("")) for path in pages} - {"index"}


def test_every_function_of_the_package_is_in_the_reference():
    text = (DOCS / "api.md").read_text(encoding="utf-8")
    assert set(fractalcontact.__all__) == set(re.findall(r"auto\w+:: fractalcontact\.(\w+)", text))


@pytest.mark.full
@pytest.mark.skipif(find_spec("sphinx") is None, reason="`make docs` installs Sphinx")
@pytest.mark.parametrize("link", ["[to](no_such_page.md)", "[to](atlas.md#no-such-heading)"])
def test_a_broken_link_fails_the_build(tmp_path, link):
    for name in ("conf.py", "atlas.md"):
        (tmp_path / name).write_text((DOCS / name).read_text(encoding="utf-8"), encoding="utf-8")
    (tmp_path / "index.md").write_text(
        f"# Start\n\n{link}\n\n```{{toctree}}\natlas\n```\n", encoding="utf-8"
    )
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
    done = subprocess.run(command, capture_output=True, text=True, env=paths, encoding="utf-8")
    assert done.returncode != 0
    assert "no" in done.stderr
    assert "such" in done.stderr
