"""A small atlas, made by the package's own functions: what the figures are drawn from in tests."""

import numpy as np
import pytest
import xarray as xr

from fractalcontact import store
from fractalcontact.analysis import analyse_domains, scaling_over_resolutions
from fractalcontact.closure import closure_curves, elastic_dilatancy
from fractalcontact.joint import describe_joint
from fractalcontact.roughness import surface_dimension
from fractalcontact.specimen import make_specimen
from fractalcontact.study import resolve_settings, window_arguments
from fractalcontact.sweep import combine, contact_states, domains_of, force_range, window_sides
from fractalcontact.synthesis import self_affine

SPACING = 0.1  # mm
SOLVER = {"rtol": 1e-6, "kernel": "love"}
STUDY = {
    "study": "tiny",
    "materials": {"rock": {"modulus": "20 GPa", "poisson": 0.2}},
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
    parts = {stage: {} for stage in store.STAGES}
    settings = {name: resolve_settings(STUDY, name, {}, "tiny") for name in STUDY["specimens"]}
    for name, (lower, upper) in _scans().items():
        chosen = settings[name]
        specimen = make_specimen(lower, upper, name=name, **window_arguments(chosen))
        joint = describe_joint(specimen, chosen)
        states = combine(
            [
                contact_states(
                    specimen,
                    direction,
                    joint["offset_cells"].sel(contact_direction=direction).values,
                    chosen,
                    chosen["resolutions"],
                    SOLVER,
                )
                for direction in chosen["contact_directions"]
            ]
        )
        curves = closure_curves(
            states,
            window_sides(specimen),
            chosen["material"]["e_star"],
            force_range(chosen["hyperbola_range"], specimen),
        )
        fields = domains_of(states)
        domains = analyse_domains(fields, SPACING)
        made = {
            "specimens": specimen,
            "surface_dimension": surface_dimension(lower.values, SPACING),
            "joints": joint,
            "contact": fields,
            "closure": curves,
            "dilatancy": elastic_dilatancy(curves, joint),
            "domains": domains,
            "scaling": scaling_over_resolutions(curves, domains, SPACING),
        }
        for stage, dataset in made.items():
            parts[stage][name] = dataset
    path = tmp_path_factory.mktemp("atlas") / "atlas.nc"
    store.write_atlas(
        parts, path, study="tiny", configuration={"study": STUDY, "settings": settings}
    )
    return path


@pytest.fixture(scope="session")
def atlas(atlas_file):
    # In memory, not open: netCDF4 does not stand the same file opened and closed a second time.
    with store.open_atlas(atlas_file) as tree:
        return tree.load()
