"""Twins of a scan: they scatter as fresh surfaces of the scan's population do."""

from dataclasses import asdict, replace

import numpy as np
import pytest
from made_stages import scan, stages_of
from materials import ROCK

from fractalcontact.core.errors import InputError
from fractalcontact.core.labels import REALISATIONS, TWINS
from fractalcontact.core.mean_plane import without_mean_plane
from fractalcontact.core.settings import EnsembleSettings, read
from fractalcontact.core.window import spacing_of
from fractalcontact.domain.random_nodes import band_of
from fractalcontact.ensemble import realisations
from fractalcontact.ensemble.realisations import ensemble
from fractalcontact.ensemble.twins import twin_loadings
from fractalcontact.error_budget.ensemble_spread import INSIDE, OUTSIDE
from fractalcontact.error_budget.error_budget import error_budget
from fractalcontact.roughness.twin_surface import twin_surface
from fractalcontact.states.loading import JointLoading
from fractalcontact.study.configuration import resolve_settings, solver_settings
from fractalcontact.surface.synthesis import band_limited

SOLVER = solver_settings({}, "tiny")
SPACING, NODES, SLID = 0.1, 64, 3


def _settings(**own):
    study = {
        "materials": {"rock": ROCK},
        "defaults": {
            "material": "rock",
            "opposite": "flat",
            "loads": ["0.5 MPa", "8 MPa", "25 MPa"],
            "dilatancy_loads": ["8 MPa"],
            "map_load": "8 MPa",
            "resolutions": [1, 2],
            **own,
        },
    }
    return resolve_settings(study, None, {}, "study")


def _surface(seed, nodes=NODES):
    """Surface of one population: heights are not scaled."""
    band = {"prefactor": 0.02, "cut_off": 0.2, "roll_off": 1.2}
    return band_limited((nodes, nodes), SPACING, 0.8, seed=seed, **band)


def _stages(heights, settings, *, upper=None):
    faces = scan(heights, SPACING), None if upper is None else scan(upper, SPACING)
    return stages_of("tiny", faces, settings, SOLVER, later=())


def _twins(known, settings, count):
    light = read(EnsembleSettings, asdict(settings))
    return ensemble(known["specimens"], known["joints"], None, count, light, SOLVER)


def test_twins_scatter_as_fresh_surfaces_of_the_same_spectrum_do(monkeypatch):
    settings = _settings()
    known = _stages(_surface(0), settings)
    twins = [_twins(_stages(_surface(seed), settings), settings, 10) for seed in range(3)]

    def fresh(loading, seeds):
        for seed in seeds:
            specimen = loading.specimen
            heights = specimen["lower"].copy(data=_surface(1000 + seed))
            yield replace(loading, specimen=specimen.assign(lower=heights))

    monkeypatch.setattr(realisations, "twin_loadings", fresh)
    seen = _twins(known, settings, 24)
    many = seen["nodes"].mean("realisation").values > 30  # of few nodes one box more is a jump
    for name in ("interface_closure", "mean_gap", "area_corrected_share", "delta_sigma"):
        spread = np.mean([one[name].std("realisation", ddof=1)[many] for one in twins], axis=0)
        scatter = seen[name].std("realisation", ddof=1).values[many]
        ratio = spread / scatter
        assert 0.6 < ratio.mean() < 1.6, (name, ratio)
        mean = np.mean([one[f"{name}_mean"][many] for one in twins], axis=0)
        apart = np.abs(mean - seen[f"{name}_mean"].values[many])
        assert (apart < 1.3 * scatter).all(), name


def _loading(known, settings):
    light = read(EnsembleSettings, asdict(settings))
    direction = light.contact_directions[0]
    whole = JointLoading.of_joint(known["specimens"], known["joints"], direction, light, SOLVER)
    return whole.at_map_offset()


def test_a_face_with_its_match_slides_its_twin_and_a_pair_has_twins_of_its_composite():
    sliding = {"opposite": "match", "directions": ["W"], "window": "4.8 mm"}
    sliding |= {"offsets": [f"{SLID * SPACING} mm"], "map_offset": f"{SLID * SPACING} mm"}
    settings = _settings(**sliding)
    face = _surface(1, 96)
    matched = _loading(_stages(face, settings), settings)
    upper = face + 0.3 + 0.002 * np.arange(96) + 0.3 * _surface(2, 96)
    pair = _loading(_stages(face, settings, upper=upper), settings)
    for loading, direction in ((matched, "W"), (pair, "none")):
        composite = loading.composite(int(loading.cells[0]))
        twins = list(twin_loadings(loading, range(1, 9)))
        assert {twin.direction for twin in twins} == {direction}
        drawn = [twin.composite(int(twin.cells[0])) for twin in twins]
        assert drawn[0].shape == composite.shape
        assert np.mean([z.std() for z in drawn]) == pytest.approx(composite.std(), rel=0.25)
        assert twins[0].area == loading.area
    # The wedge between two faces is part of what was measured.
    x = np.arange(composite.shape[1])
    tilts = [np.polyfit(x, z.mean(axis=0), 1)[0] for z in (composite, *drawn)]
    np.testing.assert_allclose(tilts[1:], tilts[0], rtol=1e-6)
    assert "twin of seed 1" in twins[0].specimen.attrs["name"]


@pytest.mark.parametrize(("along", "wide"), [("y", (2, 1)), ("x", (1, 2))])
def test_twins_have_the_cells_of_their_scan(along, wide):
    """Of cells twice as wide or tall, their spectrum is that over mm, not over cells."""
    heights = _surface(4)[:: wide[0], :: wide[1]]
    spacing = SPACING * wide[0], SPACING * wide[1]
    one = scan(heights, SPACING)
    one = one.assign_coords({along: 2 * one[along]})
    one.attrs |= {"spacing_y": spacing[0], "spacing_x": spacing[1]}
    settings = _settings()
    loading = _loading(stages_of("tiny", (one, None), settings, SOLVER, later=()), settings)
    composite = loading.composite(int(loading.cells[0]))
    plane = composite - without_mean_plane(composite)
    surface = twin_surface(composite, spacing, composite.shape)
    for seed, twin in zip((1, 2), twin_loadings(loading, (1, 2)), strict=True):
        assert spacing_of(twin.specimen) == spacing
        np.testing.assert_array_equal(twin.composite(0), plane + surface.drawn(seed))
    turned = twin_surface(composite, spacing[::-1], composite.shape)
    assert not np.allclose(turned.drawn(1), surface.drawn(1), rtol=0.01)


def test_the_spread_of_twins_takes_the_place_of_counting_and_windows_in_the_population():
    settings = _settings()
    faces = scan(_surface(3), SPACING), None
    known = stages_of("tiny", faces, settings, SOLVER, later=("closure",))
    known["ensemble"] = _twins(known, settings, 6)
    assert known["ensemble"].attrs["members"] == TWINS
    np.testing.assert_array_equal(known["ensemble"]["seed"], np.arange(1, 7))
    loading, states = _loading(known, settings), (known["closure"], known["domains"])
    with_twins, without = (
        error_budget(loading, *states, ensemble=twins) for twins in (known["ensemble"], None)
    )
    assert TWINS not in without["source"]
    assert "within_twins" not in without
    for name in ("error", "total", "relative_total", "reason"):
        other = with_twins.sel(source=without["source"])[name]
        np.testing.assert_array_equal(other, without[name], err_msg=name)
    closure = with_twins.sel(quantity="closure")
    band = known["ensemble"]["interface_closure_band_high"]
    half = (band - known["ensemble"]["interface_closure_mean"]).values
    np.testing.assert_allclose(closure["error"].sel(source=TWINS), half)
    whole = np.hypot(closure["total"], half)
    np.testing.assert_allclose(closure["total_of_population"], whole)
    assert (closure["largest_source_of_population"] == TWINS).all()
    own = known["closure"].isel(direction=0, offset=0, resolution=0)["interface_closure"]
    low = known["ensemble"]["interface_closure_band_low"].values
    seated = known["closure"].isel(direction=0, offset=0, resolution=0)["seated_closure"].values
    (seat,) = np.flatnonzero(seated == 0)
    closing = known["ensemble"]["interface_closure"].transpose("realisation", ...).values
    spread = band_of(closing - closing[:, [seat]]).width / 2
    whole = np.hypot(with_twins["seated_closure_total"], spread)
    np.testing.assert_allclose(with_twins["seated_closure_total_of_population"], whole)
    assert (whole[seat + 1 :] > 0).all()
    assert np.isnan(without["seated_closure_total_of_population"]).all()
    inside = (low <= own) & (own <= band.values)
    np.testing.assert_array_equal(closure["within_twins"] == INSIDE, inside)
    np.testing.assert_array_equal(closure["within_twins"] == OUTSIDE, ~inside)


def test_realisations_of_an_embedded_specimen_are_a_source_of_their_own_name():
    settings = _settings()
    faces = scan(_surface(3), SPACING), None
    known = stages_of("tiny", faces, settings, SOLVER, later=("closure",))
    members = _twins(known, settings, 6).assign_attrs(members=REALISATIONS)
    states = known["closure"], known["domains"]
    budget = error_budget(_loading(known, settings), *states, ensemble=members)
    assert "within_twins" not in budget
    assert TWINS not in budget["source"]
    gap = budget.sel(quantity="separation")
    whole = np.hypot(gap["total"], gap["error"].sel(source=REALISATIONS))
    np.testing.assert_allclose(gap["total_of_population"], whole)
    assert (gap["largest_source_of_population"] == REALISATIONS).all()


def test_a_flat_surface_has_no_twins_and_the_key_is_named():
    settings = _settings()
    known = _stages(_surface(0), settings)
    known["specimens"]["lower"] *= 0
    with pytest.raises(InputError, match=r"specimen tiny, key 'twins': .*remove the key"):
        _twins(known, settings, 3)
