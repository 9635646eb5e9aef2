"""The explorer's page holds what the atlas holds, and nothing that it does not."""

import base64
import json
import re
import zlib
from dataclasses import asdict

import numpy as np
import pytest
import xarray as xr
from made_stages import scan, stages_of
from stage_names import STAGES
from unchecked_settings import resolve_unchecked

from fractalcontact.joint.overlap import overlapping_nodes, suspect_nodes
from fractalcontact.pages import packed_states as packing
from fractalcontact.pages.explorer import write_explorer
from fractalcontact.pages.packed_states import GAP_STEPS, ORDER, packed, packed_states
from fractalcontact.study.atlas import read_atlas, write_atlas
from fractalcontact.study.configuration import solver_settings
from fractalcontact.surface.synthesis import self_affine

HOSTILE = "</script><script>alert(1)</script>"
STUDY = {
    "study": "tiny",
    "materials": {"rock": {"modulus": "20 GPa", "poisson": 0.2}},
    "defaults": {"material": "rock", "loads": ["0.5 MPa", "5 MPa", "25 MPa"]},
    "specimens": {
        # Two faces that overlap, two directions, an oblong window; most states are not solved.
        "pair": {
            "contact_directions": ["N", "E"],
            "directions": ["N", "E"],
            "offsets": ["0 mm", "0.2 mm", "0.6 mm"],
            "window": ["3.2 mm", "4.8 mm"],
            "resolutions": [1, 2],
        },
        "flat": {"opposite": "flat", "window": "4.8 mm", "resolutions": [1]},
    },
}


SOLVER = solver_settings({}, "tiny")


@pytest.fixture(scope="module")
def atlas_file(tmp_path_factory):
    def surface(cells, seed):
        return self_affine((cells, cells), 0.1, 0.8, rms=0.1, seed=seed, roll_off=1.5)

    lower = surface(80, 1)
    upper = lower + 0.2 * surface(80, 2) + 0.02
    scans = {
        "pair": (scan(lower, 0.1), scan(upper, 0.1)),
        "flat": (scan(surface(48, 4), 0.1), None),
    }
    parts = {stage: {} for stage in STAGES}
    settings = {name: resolve_unchecked(STUDY, name, {}, "tiny") for name in scans}
    for name, faces in scans.items():
        made = stages_of(name, faces, settings[name], SOLVER, ["closure", "flow"])
        for stage, dataset in made.items():
            parts[stage][name] = dataset
    path = tmp_path_factory.mktemp("tiny") / "atlas.nc"
    parts["specimens"]["pair"].attrs["label"] = HOSTILE
    records = {name: asdict(stated) for name, stated in settings.items()}
    write_atlas(parts, path, study="tiny", configuration={"settings": records})
    return path


@pytest.fixture(scope="module")
def atlas(atlas_file):
    return read_atlas(atlas_file)


def inflated(text):
    return np.frombuffer(zlib.decompress(base64.b64decode(text)), np.uint8)


def unpacked(text, dtype):
    size = np.dtype(dtype).itemsize
    return inflated(text).reshape(size, -1).T.copy().view(dtype).ravel()


def bits(text, shape):
    rows = inflated(text).reshape(*shape[:-1], -1)
    return np.unpackbits(rows, axis=-1)[..., : shape[-1]].astype(bool)


@pytest.mark.parametrize("dtype", ["<f8", "<f4", "<u2"])
def test_numbers_come_back_bit_for_bit(dtype):
    values = np.random.default_rng(0).integers(0, 2**16, 1001).astype(dtype)
    values[3] = 0
    assert np.array_equal(unpacked(packed(values), dtype), values)


def at_the_reported_offset(data, closure):
    """Numbers over loads at their place among all states, all others missing."""
    place = {
        name: closure[f"reported_{name}"].item() for name in ("direction", "offset", "resolution")
    }
    everywhere = xr.full_like(closure["closure"], np.nan)
    everywhere.loc[place] = data.values
    return everywhere


@pytest.mark.parametrize("name", ["pair", "flat"])
def test_every_number_is_the_atlas_s(atlas, name):
    states = packed_states(atlas, name)
    numbers = unpacked(states["numbers"], "<f8")
    compared = 0
    for key, entry in states["arrays"].items():
        if key.startswith(("total/", "undetermined/")):
            continue  # of no variable of their own: tests/pages/test_one_value.py
        data = atlas[f"{entry['stage']}/{name}"].to_dataset()[entry["variable"]]
        if entry["stage"] == "dilatancy":
            data = data.rename({"direction": "rigid_direction"} if "direction" in data.dims else {})
            of_contact = "contact_direction" in data.dims
            data = data.rename({"contact_direction": "direction"} if of_contact else {})
        if entry["stage"] == "flow":
            data = at_the_reported_offset(data, atlas[f"closure/{name}"].to_dataset())
        data = data.transpose(*(dim for dim in ORDER if dim in data.dims))
        assert entry["dims"] == list(data.dims)
        found = numbers[entry["start"] :][: data.size].reshape(data.shape)
        np.testing.assert_array_equal(found, data.values.astype(float))
        compared += np.isfinite(found).sum()
    assert compared > 100
    json.dumps(states, allow_nan=False)


def test_flow_has_the_interval_of_the_page(atlas):
    states = packed_states(atlas, "pair")
    for name in ("transmissivity_along", "transmissivity_across", "hydraulic_aperture_along"):
        for end in ("low", "high"):
            assert f"flow/{name}_{end}" in states["arrays"]


def test_the_count_law_passes_through_the_counts_it_was_fitted_to(atlas):
    states = packed_states(atlas, "pair")
    entry, numbers = states["arrays"]["law_count"], unpacked(states["numbers"], "<f8")
    law = numbers[entry["start"] :][: np.prod(entry["shape"])].reshape(entry["shape"])
    domains = atlas["domains/pair"].to_dataset()
    counts = domains["mean_count"].transpose(*entry["dims"]).values
    fitted = np.isfinite(domains["delta_sigma"]).transpose(*entry["dims"][:-1]).values
    assert fitted.any()
    assert np.array_equal(np.isfinite(law).any(axis=-1), fitted)
    np.testing.assert_allclose(law[np.isfinite(law)], counts[np.isfinite(law)], rtol=0.25)


@pytest.mark.parametrize("name", ["pair", "flat"])
def test_contact_domains_are_the_atlas_s(atlas, name):
    states, contact = packed_states(atlas, name), atlas[f"contact/{name}"].to_dataset()
    unsolved = 0
    for factor in contact["resolution"].values:
        field = contact[f"in_contact_{factor}"]
        field = field.transpose("direction", "offset", "normal_force", ...).values
        stored = states["domains"][factor]
        assert stored["shape"] == list(field.shape[3:])
        for text, expected in zip(
            np.ravel(stored["bits"]), field.reshape(-1, *field.shape[2:]), strict=True
        ):
            if text:
                assert np.array_equal(bits(text, expected.shape), expected == 1)
            else:
                assert np.isnan(expected).all()
                unsolved += 1
    assert (unsolved > 0) == (name == "pair")


def test_fields_are_the_atlas_s_where_it_has_them(atlas):
    fields, contact = packed_states(atlas, "pair")["fields"], atlas["contact/pair"].to_dataset()
    assert fields["direction"] == contact.attrs["map_direction"]
    pressure, gap = (contact[f"map_{kind}"].values for kind in ("pressure", "gap"))
    for kind, values in (("pressure", pressure), ("gap", gap)):
        stored = np.isfinite(values).any(axis=(1, 2))
        assert fields[kind]["loads"] == np.flatnonzero(stored).tolist()
        assert stored.any()
    for text, load in zip(fields["pressure"]["data"], fields["pressure"]["loads"], strict=True):
        assert np.array_equal(unpacked(text, "<f4"), pressure[load].ravel())
    flux = atlas["flow/pair"]["flux_map_along"].values
    (text,), (load,) = fields["flow"]["data"], fields["flow"]["loads"]
    assert contact["normal_force"].values[load] == pytest.approx(contact.attrs["map_load"])
    packed = unpacked(text, "<f4").reshape(flux.shape)
    np.testing.assert_allclose(packed, flux, rtol=2**-8)
    for text, load in zip(fields["gap"]["data"], fields["gap"]["loads"], strict=True):
        changes = unpacked(text, "<u2").reshape(gap[load].shape)
        steps = np.cumsum(changes, axis=1, dtype="<u2")
        error = steps * fields["gap"]["step"] - gap[load]
        assert np.abs(error).max() <= np.nanmax(gap) / GAP_STEPS


def small_fields(gaps):
    """Fields of states under two loads, the heavier one the reference load."""
    dims = ("normal_force", "y", "x")
    values = np.asarray(gaps, float)
    places = {"map_direction": "W", "map_offset": 0.1, "map_resolution": 1, "map_load": 20.0}
    contact = xr.Dataset(
        {
            "map_pressure": (dims, np.ones_like(values), {"units": "MPa"}),
            "map_gap": (dims, values, {"units": "mm"}),
        },
        coords={"normal_force": [10.0, 20.0]},
        attrs=places,
    )
    flux = xr.Dataset({"flux_map_along": (("flow_y", "flow_x"), np.ones(values.shape[1:]))})
    return packing._fields(contact, flux)


def test_of_a_large_window_the_gap_is_kept_under_the_reference_load_alone(monkeypatch):
    gaps = np.ones((2, 3, 4))
    assert small_fields(gaps)["gap"]["loads"] == [0, 1]
    monkeypatch.setattr(packing, "MAX_GAPS", 23)
    fields = small_fields(gaps)
    assert fields["gap"]["loads"] == [1]
    assert fields["pressure"]["loads"] == [0, 1]


def test_a_negative_gap_is_zero_and_a_missing_one_has_a_code_of_its_own():
    gaps = np.array([[[1.0, -0.5, np.nan, 0.25]]] * 2)
    gap = small_fields(gaps)["gap"]
    changes = unpacked(gap["data"][0], "<u2")
    steps = np.cumsum(changes, dtype="<u2")
    assert steps.tolist() == [GAP_STEPS, 0, gap["missing"], GAP_STEPS // 4]


def test_marks_are_where_the_faces_overlap_or_are_suspicious(atlas):
    states, specimen = packed_states(atlas, "pair"), atlas["specimens/pair"].to_dataset()
    joint, shape = atlas["joints/pair"].to_dataset(), states["window"]["shape"]
    assert shape == [32, 48]
    found = 0
    for d, direction in enumerate(states["direction"]):
        for o, cells in enumerate(joint["offset_cells"].values[d]):
            overlap = overlapping_nodes(specimen, direction, int(cells))
            other = suspect_nodes(specimen, direction, int(cells)) & ~overlap
            for kind, expected in (("overlap", overlap), ("suspect", other)):
                text = states["marks"][kind][d][o]
                assert np.array_equal(
                    bits(text, shape) if text else np.zeros(shape, bool), expected
                )
                found += expected.sum()
    assert found > 10
    assert packed_states(atlas, "flat")["marks"] is None


def test_nodes_of_oblong_cells_stand_at_their_places(atlas):
    """Numbers along y come first: the first node and a spacing a node lead to the last one."""
    tree = atlas.copy()
    tree["specimens/pair"].attrs["spacing_y"] *= 2
    contact = tree["contact/pair"].to_dataset()
    contact = contact.assign_coords({f"y_{k}": 2 * contact[f"y_{k}"] for k in (1, 2)})
    tree["contact/pair"] = xr.DataTree(contact)
    window = packed_states(tree, "pair")["window"]
    for axis, first, spacing, n in zip(
        "yx", window["first"], window["spacing"], window["shape"], strict=True
    ):
        np.testing.assert_allclose(first + spacing * np.arange(n), contact[f"{axis}_1"])
    assert window["cell_side"] ** 2 == pytest.approx(np.prod(window["spacing"]))


def test_numbers_are_undetermined_where_the_atlas_says_so(atlas):
    tree = atlas.copy()
    closure, domains = (tree[f"{stage}/pair"].to_dataset() for stage in ("closure", "domains"))
    share = closure["suspect_load_share"]
    suspect = np.resize([0.0, 0.9, 0.3, np.nan, 1.0], share.shape)
    half = np.resize([0.01, 3.0], domains["delta_sigma"].shape)
    known = np.isfinite(domains["delta_sigma"].values)
    assert {0.01, 3.0} == set(half[known])
    tree["closure/pair"] = xr.DataTree(closure.assign(suspect_load_share=share.copy(data=suspect)))
    ends = {
        f"delta_sigma_{end}": domains["delta_sigma"] + sign * half
        for end, sign in (("low", -1), ("high", 1))
    }
    tree["domains/pair"] = xr.DataTree(domains.assign(ends))
    states = packed_states(tree, "pair")
    numbers = unpacked(states["numbers"], "<f8")

    def mask(key, dims):
        entry = states["arrays"][f"undetermined/{key}"]
        values = numbers[entry["start"] :][: np.prod(entry["shape"])].reshape(entry["shape"])
        return xr.DataArray(values, dims=entry["dims"]).transpose(*dims).values

    np.testing.assert_array_equal(mask("by_scan", share.dims) == 1, suspect > 0.5)
    wide = mask("domains/delta_sigma", domains["delta_sigma"].dims) == 1
    np.testing.assert_array_equal(wide[known], half[known] == 3.0)


def test_the_page_is_one_file_that_runs_nothing_of_a_label(atlas_file, tmp_path):
    write_explorer(atlas_file, tmp_path / "explorer.html")
    assert [path.name for path in tmp_path.iterdir()] == ["explorer.html"]
    text = (tmp_path / "explorer.html").read_text(encoding="utf-8")
    assert "<script>alert" not in text
    assert not re.search(r"https?://(?!www\.w3\.org/2000/svg)", text)
    index = json.loads(re.search(r'id="index">(.*?)</script>', text).group(1))
    assert {"name": "pair", "label": HOSTILE} in index["specimens"]
