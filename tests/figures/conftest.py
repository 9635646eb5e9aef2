"""A small atlas, by the functions that the jobs of a study call: what tests draw figures from."""

import warnings
from dataclasses import asdict

import numpy as np
import pytest
import xarray as xr
from drawings import draw, keep_drawings
from made_stages import scan, stages_of
from made_tests import with_tests
from materials import ROCK
from stage_names import EXPERIMENTS, STAGES
from unchecked_settings import resolve_unchecked

from contactlab.experiments.area_slope import area_slope
from contactlab.experiments.delta_g import estimator_bias
from contactlab.experiments.roll_off import roll_off_effect
from contactlab.experiments.size_effect_verdict import size_effect_verdict
from contactlab.experiments.size_states import solve_task
from contactlab.experiments.size_strength import size_strength
from contactlab.experiments.size_tasks import size_tasks
from fractalcontact.stages.atlas import join_stages
from fractalcontact.study.atlas import read_atlas
from fractalcontact.study.configuration import solver_settings
from fractalcontact.study.figure_list import all_figures
from fractalcontact.surface.synthesis import self_affine

SPACING = 0.1  # mm
SOLVER = solver_settings({}, "tiny")
AREA_SLOPE = {
    "dimension": 2.2,
    "nodes": 64,
    "seeds": [1, 2],
    "roll_off_share": 0.25,
    "loads": [0.01, 0.02],
}
STUDY = {
    "study": "tiny",
    "materials": {"rock": ROCK},
    "defaults": {
        "material": "rock",
        "contact_directions": ["W"],
        "loads": ["0.1 MPa", "1 MPa", "5 MPa", "12.5 MPa", "25 MPa", "75 MPa"],
        "resolutions": [1, 2, 4],
        "window": "4.8 mm",
    },
    "specimens": {
        # Slides in four directions, one face scanned.
        "sliding": {
            "label": "synthetic twin of nothing",
            "offsets": [f"{v} mm" for v in (0.1, 0.2, 0.4, 0.6, 1, 1.6, 2.4)],
            "map_offset": "0.4 mm",
        },
        # A surface against a plane: one offset, direction "none".
        "flat": {"opposite": "flat"},
        # Two faces, a hole and a corner missing, one resolution, an oblong window, too few loads
        # for a hyperbola.
        "pair": {
            "label": "Brèche, deux faces — épaulée",
            "contact_directions": ["N"],
            "directions": ["N", "E"],
            "offsets": ["0 mm", "0.2 mm", "0.6 mm"],
            "window": ["3.2 mm", "4.8 mm"],
            "loads": ["0.5 MPa", "5 MPa", "25 MPa"],
            "resolutions": [1],
        },
    },
}
ESTIMATOR_BIAS = {"hurst": [0.8], "sizes": [64], "seeds": [1, 2]}
SIZE_EFFECT = {
    "hurst": [0.5, 0.8],
    "loads": [0.01, 0.1],
    "cut_off": 4,
    "roll_off": 8,
    "roll_off_fraction": 0.25,
    "arms": {
        "R": {"sizes": [32], "surfaces": [2], "cut_offs": [4, 8]},
        "S1": {"sizes": [32, 48], "surfaces": [2, 2]},
    },
}
SIZE_STRENGTH = {
    "hurst": [0.5, 0.8],
    "loads": [0.05],
    "hardness": 0.5,
    "cut_off": 4,
    "roll_off": 8,
    "rms_slope": 0.3,
    "basic_friction_angle": 30,
    "offsets": [2, 4, 8],
    "sizes": [32, 64],
    "surfaces": [2, 2],
}
ROLL_OFF = {
    "label": "made joints",
    "size": 9.6,
    "outline": "square",
    "spacing": SPACING,
    "dimension": 2.2,
    "rms": 0.1,
    "roll_off": 1.5,
}


def _scans():
    """Lower and upper face by specimen."""

    def surface(cells, seed):
        return self_affine((cells, cells), SPACING, 0.8, rms=0.1, seed=seed, roll_off=1.5)

    lower = surface(96, 1)
    upper = lower + 0.1 * surface(96, 2) + 0.3
    lower[:20, :12] = np.nan
    upper[-3:, -30:] = np.nan
    return {
        "sliding": (scan(surface(96, 3), SPACING), None),
        "flat": (scan(surface(48, 4), SPACING), None),
        "pair": (scan(lower, SPACING), scan(upper, SPACING)),
    }


@pytest.fixture(scope="session")
def atlas_file(tmp_path_factory):
    """Path of an atlas with the specimens sliding, flat and pair."""
    parts = {stage: {} for stage in STAGES}
    settings = {name: resolve_unchecked(STUDY, name, {}, "tiny") for name in STUDY["specimens"]}
    folder = tmp_path_factory.mktemp("atlas")
    for name, faces in _scans().items():
        made = stages_of(name, faces, settings[name], SOLVER)
        if name == "sliding":
            settings[name], made = with_tests(made, settings[name], SOLVER, folder)
        for stage, dataset in made.items():
            parts[stage][name] = dataset
    for stage, dataset in _experiments().items():
        parts[stage]["surfaces"] = dataset
    path = folder / "atlas.nc"
    records = {name: asdict(stated) for name, stated in settings.items()}
    join_stages(parts, path, {"study": STUDY, "settings": records})
    return path


def _experiments():
    """Stages that a study has once."""
    computed = {
        "area_slope": area_slope(AREA_SLOPE),
        "estimator_bias": estimator_bias(ESTIMATOR_BIAS),
        "roll_off": roll_off_effect(ROLL_OFF, 4.8, [1, 2]),
        "size_effect": size_effect_verdict(
            [solve_task(task, SIZE_EFFECT["loads"], 1e-4) for task in size_tasks(SIZE_EFFECT)],
            SIZE_EFFECT,
        ),
        "size_strength": size_strength(SIZE_STRENGTH, 1e-4),
    }
    assert computed.keys() <= set(EXPERIMENTS)
    return computed


@pytest.fixture(scope="session")
def atlas(atlas_file):
    return keep_drawings(read_atlas(atlas_file))


@pytest.fixture(scope="session")
def marked(atlas):
    """The atlas with words of its own for every verdict."""
    changed = atlas.copy()
    for name in STUDY["specimens"]:
        judged = atlas[f"statements/{name}"].to_dataset()
        said = [f"verdict_{i}" for i in range(judged.sizes["statement"])]
        judged["verdict"] = judged["verdict"].copy(data=np.array(said, object))
        changed[f"statements/{name}"] = xr.DataTree(judged)
    return changed


@pytest.fixture(scope="session")
def drawn(marked):
    """A figure of the marked atlas, drawn once, from no other stage than those it states."""
    known = {}

    def once(figure, subject):
        if (figure, str(subject)) not in known:
            needed = marked.copy()
            for stage in set(STAGES) - set(all_figures()[figure].needs):
                if stage in needed.children:
                    del needed[stage]
            with warnings.catch_warnings():
                warnings.simplefilter("error", UserWarning)
                warnings.simplefilter("error", RuntimeWarning)
                known[figure, str(subject)] = draw(needed, figure, subject)
        return known[figure, str(subject)]

    return once
