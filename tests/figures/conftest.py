"""A small atlas, made by the package's own functions: what the figures are drawn from in tests."""

import numpy as np
import pytest
import xarray as xr

from fractalcontact.domain.analysis import analyse_domains, scaling_over_resolutions
from fractalcontact.domain.measures import measures_of_map_states
from fractalcontact.experiments.area_slope import area_slope
from fractalcontact.experiments.delta_g import estimator_bias
from fractalcontact.experiments.delta_sigma import dimension_test
from fractalcontact.experiments.roll_off import roll_off_effect
from fractalcontact.mechanics.area import area_laws, joint_statistics
from fractalcontact.mechanics.closure import closure_curves, elastic_dilatancy
from fractalcontact.mechanics.joint import describe_joint
from fractalcontact.mechanics.loading import JointLoading
from fractalcontact.mechanics.plan import solve_plan
from fractalcontact.mechanics.states import combine, domains_of, force_range, map_states
from fractalcontact.mechanics.strength import joint_strength
from fractalcontact.mechanics.sweep import joint_states
from fractalcontact.roughness.dimension import best_dimension, surface_dimension
from fractalcontact.roughness.quality import scan_quality
from fractalcontact.size_effect.eq6 import size_test
from fractalcontact.size_effect.laws import joint_by_size
from fractalcontact.statements.judge import judge
from fractalcontact.study.atlas import STAGES, read_atlas, write_atlas
from fractalcontact.study.configuration import resolve_settings, solver_settings, window_arguments
from fractalcontact.surface.specimen import make_specimen, window_sides
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
    "materials": {
        "rock": {
            "modulus": "20 GPa",
            "poisson": 0.2,
            "basic_friction_angle": "30 deg",
            "joint_wall_strength": "80 MPa",
        }
    },
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
DIMENSION_TEST = {
    "dimensions": [2.2],
    "sizes": [32, 64],
    "seeds": [1, 2],
    "loads": [0.02, 0.1],
    "resolutions": [1, 2, 4],
    "hardness": 0.5,
    "capped_loads": [0.1, 0.5, 0.9],
    "capped_size": 32,
}
ESTIMATOR_BIAS = {"hurst": [0.8], "sizes": [64], "seeds": [1, 2]}
ROLL_OFF = {
    "label": "made joints",
    "size": 9.6,
    "outline": "square",
    "spacing": SPACING,
    "dimension": 2.2,
    "rms": 0.1,
    "roll_off": 1.5,
}


def _scan(heights):
    coordinates = [SPACING * (np.arange(n) + 0.5) for n in heights.shape]
    attrs = {"spacing_x": SPACING, "spacing_y": SPACING, "source": "made", "sha256": "0" * 64}
    return xr.DataArray(heights, dims=("y", "x"), coords=coordinates, attrs=attrs)


def _scans():
    """Lower and upper face by specimen."""

    def surface(cells, seed):
        return self_affine((cells, cells), SPACING, 0.8, rms=0.1, seed=seed, roll_off=1.5)

    lower = surface(96, 1)
    upper = lower + 0.1 * surface(96, 2) + 0.3
    lower[:20, :12] = np.nan
    upper[-3:, -30:] = np.nan
    return {
        "sliding": (_scan(surface(96, 3)), None),
        "flat": (_scan(surface(48, 4)), None),
        "pair": (_scan(lower), _scan(upper)),
    }


@pytest.fixture(scope="session")
def atlas_file(tmp_path_factory):
    """Path of an atlas with the specimens sliding, flat and pair."""
    parts = {stage: {} for stage in STAGES}
    settings = {name: resolve_settings(STUDY, name, {}, "tiny") for name in STUDY["specimens"]}
    for name, (lower, upper) in _scans().items():
        chosen = settings[name]
        specimen = make_specimen(lower, upper, name=name, **window_arguments(chosen))
        joint = describe_joint(specimen, chosen)
        solved = joint_states(
            specimen,
            joint,
            chosen["contact_directions"],
            slice(None),
            chosen,
            chosen["resolutions"],
            SOLVER,
        )
        states = combine([solved])
        curves = closure_curves(
            states,
            window_sides(specimen),
            chosen["material"]["e_star"],
            force_range(chosen["hyperbola_range"], specimen),
        )
        fields = domains_of(states)
        domains = analyse_domains(fields, SPACING)
        dimension = surface_dimension(lower.values, SPACING)
        dilatancy = elastic_dilatancy(curves, joint)
        area = area_laws(
            curves,
            joint_statistics(specimen, joint),
            chosen["material"]["e_star"],
            best_dimension(dimension)[0],
        )
        loading = JointLoading(
            specimen,
            chosen["contact_directions"][0],
            np.sort(joint["offset_cells"][0].values),
            chosen,
            SOLVER,
        )
        windows = joint_by_size(loading, best_dimension(dimension))
        made = {
            "specimens": specimen,
            "quality": scan_quality(specimen, chosen["resolutions"]),
            "surface_dimension": dimension,
            "joints": joint,
            "contact": fields,
            "closure": curves,
            "choices": solve_plan(curves, dilatancy, chosen, SOLVER),
            "dilatancy": dilatancy,
            "area": area,
            "windows": windows,
            "domains": domains,
            "scaling": scaling_over_resolutions(curves, domains, SPACING),
        }
        made["size_test"] = size_test(loading, windows)
        made["domain_measures"] = measures_of_map_states(map_states([solved]), SPACING)
        made["statements"] = judge(made, chosen)
        if name != "flat":
            made["strength"] = joint_strength(dilatancy, joint, specimen, chosen)
        for stage, dataset in made.items():
            parts[stage][name] = dataset
    parts["area_slope"]["surfaces"] = area_slope(AREA_SLOPE)
    parts["dimension_test"]["surfaces"] = dimension_test(DIMENSION_TEST)
    parts["estimator_bias"]["surfaces"] = estimator_bias(ESTIMATOR_BIAS)
    parts["roll_off"]["surfaces"] = roll_off_effect(ROLL_OFF, 4.8, [1, 2])
    path = tmp_path_factory.mktemp("atlas") / "atlas.nc"
    write_atlas(parts, path, study="tiny", configuration={"study": STUDY, "settings": settings})
    return path


@pytest.fixture(scope="session")
def atlas(atlas_file):
    return read_atlas(atlas_file)
