"""Every study of the project resolves as it is recorded, with sidecars of many kinds."""

import hashlib
import json
from dataclasses import asdict
from pathlib import Path

import pytest
from places import ROOT

from fractalcontact.study.checks import check_study
from fractalcontact.study.configuration import (
    resolve_embedded,
    resolve_roll_off,
    resolve_settings,
    solver_settings,
)
from fractalcontact.study.documents import read_study
from fractalcontact.study.scan_files import ScanFiles

STUDIES = [*ROOT.glob("config/*.yaml"), *ROOT.glob("config/examples/*.yaml")]
NAMES = sorted(path.relative_to(ROOT).as_posix() for path in STUDIES if path.stem != "mine")
#: First digits of the SHA-256 of each resolution, by study; those of 1.0.0. A new key of specimens
#: changes all of `one`, `pair` and `settings`: run this file to record them.
RECORD = ROOT / "tests/study/resolutions.json"
SIDECAR = Path("scans/rock.yaml")
SCANS = {
    "one": ScanFiles("rock", Path("scans/rock.x3p"), None, SIDECAR),
    "pair": ScanFiles("rock", Path("scans/rock.lower.x3p"), Path("scans/rock.upper.x3p"), SIDECAR),
}
TEST = {"file": "load.csv", "gauge": "joint", "seat": "0.25 MPa", "branch": "load", "cycle": 1}
UNLOADING = TEST | {"branch": "unload", "gauge": {"length": "100 mm", "modulus": "60 GPa"}}
FLOW = {"file": "f.csv", "way": "along", "branch": "load", "cycle": 1}
ROCK = {"modulus": "50 GPa", "poisson": 0.25}
WALLS = ROCK | {"joint_wall_strength": "90 MPa"}
SIDECARS = [
    {},
    {"opposite": "flat"},
    {"label": "a rock", "group": "g"},
    {"window": "5 mm", "window_centre": ["1 mm", "2 cm"]},
    {"window": "auto", "offsets": "auto"},
    {"offsets": ["0.1 mm", "200 um"], "map_offset": "0.2 mm"},
    {"offsets": ["0 mm", "1 mm"]},
    {
        "loads": ["1 MPa", "2 MPa", "10 kN"],
        "dilatancy_loads": ["1 MPa"],
        "map_load": "10 kN",
    },
    {"resolutions": [4, 1, 2]},
    {"directions": ["E", "W"], "contact_directions": ["E"]},
    {"hyperbola_range": ["1 MPa", "10 MPa"], "seating_pressure": "1 MPa"},
    {"surface_range": ["0.2 mm", "2 mm"], "box_range": "auto", "scaling_range": ["1 mm", "5 mm"]},
    {"twins": 3, "outliers": "fill", "fill_holes": 3},
    {"material": ROCK},
    {"material": WALLS | {"basic_friction_angle": "30 deg"}},
    {"material": WALLS | {"hardness": "none"}},
    {"measured": {"closure": TEST}},
    {
        "measured": {
            "closure": [TEST | {"gauge": "4 um/MPa", "error": "1 um"}, UNLOADING],
            "flow": FLOW | {"columns": {"hydraulic_aperture": "h [um]"}},
            "shear": {"file": "s.csv", "pressure": "5 MPa", "direction": "E"},
        }
    },
]


def resolutions(source):
    """All that a study resolves to, by what it is of."""
    config = read_study(ROOT / source)
    check_study(config, source)
    found = {"solver": asdict(solver_settings(config, source))}
    for name, recipe in config.get("embedded", {}).items():
        found[f"embedded {name}"] = resolve_embedded(recipe, f"{source}: embedded.{name}")
        found[f"settings {name}"] = asdict(resolve_settings(config, name, {}, source))
    if "roll_off" in config:
        found["roll_off"] = resolve_roll_off(config, source)
    for n, own in enumerate(SIDECARS if "defaults" in config else ()):
        for kind, scan in SCANS.items():
            settings = resolve_settings(config, "rock", own, source, scan)
            found[f"{kind} {n}"] = asdict(settings)
    return found


def digests(source):
    return {
        name: hashlib.sha256(json.dumps(one, sort_keys=True).encode()).hexdigest()[:16]
        for name, one in resolutions(source).items()
    }


@pytest.mark.parametrize("source", NAMES)
def test_a_study_resolves_as_recorded(source):
    recorded = json.loads(RECORD.read_text())[source]
    found = digests(source)
    assert {name: found[name] for name in found if found[name] != recorded.get(name)} == {}
    assert found.keys() == recorded.keys()


if __name__ == "__main__":
    made = {source: digests(source) for source in NAMES}
    RECORD.write_text(json.dumps(made, indent=0, sort_keys=True) + "\n")
