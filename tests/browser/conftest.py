"""A small study from scans to pages, and a browser that records what it was asked and what failed.

``RESULTS=results/paper`` takes the results of a study that was made already. What the tests see
goes to ``results/browser``.
"""

import os
import shutil
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
import yaml
from places import ROOT
from projects import copy_project, made, small_study
from stated import ARRAY

from fractalcontact.study.atlas import read_atlas
from fractalcontact.surface.synthesis import self_affine

SHOTS = ROOT / "results/browser"
DESKTOP = {"viewport": {"width": 1280, "height": 900}}
PHONE = "Pixel 7"
#: A label that would run if any page took it for HTML.
HOSTILE = "<img src=x onerror=alert(1)> </script><script>alert(2)</script> 'q' & \"d\""


@pytest.fixture(scope="session")
def results(tmp_path_factory):
    """Folder of the results of a study: a twin, a surface against a plane, two scanned faces."""
    if os.environ.get("RESULTS"):
        return Path(os.environ["RESULTS"]).absolute()
    project = copy_project(tmp_path_factory.mktemp("project"))
    smoke = yaml.safe_load((project / "config/smoke.yaml").read_text())
    study = small_study(
        project,
        embedded=smoke["embedded"],
        specimens=smoke["specimens"],
        defaults=smoke["defaults"] | {"contact_directions": ["W", "E"]},
    )
    _write_pair(project / "scans")
    done = made(project, study)
    assert done.returncode == 0, done.stderr[-3000:]
    return project / "results/test"


def _write_pair(folder):
    """Two faces that overlap here and there as scanned."""
    lower = self_affine((96, 96), 0.1, 0.8, rms=0.1, seed=1, roll_off=1.5)
    upper = lower + 0.2 * self_affine((96, 96), 0.1, 0.8, rms=0.1, seed=2, roll_off=1.5) + 0.02
    for face, heights in (("lower", lower), ("upper", upper)):
        np.save(folder / f"faces.{face}.npy", heights)
    sidecar = {
        **ARRAY,
        "unit": "mm",
        "spacing": 0.1,
        "registration": "none",
        "window": "4.8 mm",
        "offsets": ["0 mm", "0.3 mm"],
        "label": HOSTILE,
    }
    (folder / "faces.yaml").write_text(yaml.safe_dump(sidecar))


@pytest.fixture(scope="session")
def atlas(results):
    return read_atlas(results / "atlas.nc")


@pytest.fixture(scope="session")
def shots():
    """Folder of the screenshots."""
    SHOTS.mkdir(parents=True, exist_ok=True)
    return SHOTS


@pytest.fixture(scope="session")
def report(shots):
    """Lines on the sizes of the pages and the times that they take to open."""
    lines = []
    yield lines
    (shots / "report.txt").write_text("".join(f"{line}\n" for line in lines))


@pytest.fixture(scope="session")
def playwright():
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        yield playwright


@pytest.fixture(scope="session")
def chromium(playwright):
    path = shutil.which(os.environ["CHROMIUM"])
    # Root, as in a container, has no sandbox; the pages are the project's own.
    options = ["--no-sandbox"] if os.geteuid() == 0 else []
    browser = playwright.chromium.launch(executable_path=path, args=options)
    yield browser
    browser.close()


@pytest.fixture
def open_page(playwright, chromium, results):
    """Opens a page of the study from the disk; none may ask for more, or say that it failed."""

    @contextmanager
    def opened(name, *, phone=False):
        device = playwright.devices[PHONE] if phone else DESKTOP
        context = chromium.new_context(**device, accept_downloads=False)
        page = context.new_page()
        wrong, asked = [], []
        page.on("console", lambda m: wrong.append(f"{m.type}: {m.text}"))
        page.on("pageerror", lambda error: wrong.append(str(error)))
        page.on("dialog", lambda dialog: wrong.append(dialog.message))
        page.on("request", lambda request: asked.append(request.url))
        page.goto((results / name).as_uri() if "#" not in name else _with_hash(results, name))
        yield page
        context.close()
        assert wrong == []
        outside = [url for url in asked if not url.startswith((results.as_uri(), "data:", "blob:"))]
        assert outside == []

    return opened


def _with_hash(results, name):
    path, view = name.split("#", 1)
    return f"{(results / path).as_uri()}#{view}"
