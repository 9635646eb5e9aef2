"""A study with a result page: a hostile label, and few nodes in contact at the smallest load."""

from dataclasses import asdict

from made_stages import scan, stages_of
from made_tests import with_tests
from materials import ROCK
from spreadsheets import FORMULA
from stage_names import STAGES
from unchecked_settings import resolve_unchecked

from fractalcontact.core.subject import configuration_of
from fractalcontact.pages.files import EXPLORER
from fractalcontact.pages.result_page import Place, write_index, write_specimen_pages
from fractalcontact.stages.atlas import join_stages
from fractalcontact.study.atlas_parts import Trees
from fractalcontact.study.campaign import explored
from fractalcontact.study.configuration import solver_settings
from fractalcontact.surface.synthesis import self_affine

HOSTILE = "</script><script>alert(1)</script><img src='https://x.example/a.png'> $\\alpha$ \"q\""
STUDY = {
    "study": "tiny",
    "materials": {"rock": ROCK},
    "defaults": {
        "material": "rock",
        "contact_directions": ["W"],
        "directions": ["W", "E"],
        "loads": ["1 MPa", "12.5 MPa", "125 MPa", "250 MPa"],
        "dilatancy_loads": ["1 MPa", "250 MPa"],
        "map_load": "125 MPa",
        "resolutions": [1, 2],
        "window": "3.2 mm",
    },
    "specimens": {
        # Suspicious cells carry most of the load of its maps, and its separation is negative.
        "pair": {
            "offsets": ["0 mm", "0.2 mm", "0.6 mm"],
            "map_offset": "0 mm",
            "label": HOSTILE,
        },
        "flat.1": {"opposite": "flat", "label": FORMULA},
    },
}


def write_study(folder):
    """Atlas in a folder, of two scanned faces and a surface against a plane; their settings."""

    def surface(cells, seed):
        return self_affine((cells, cells), 0.1, 0.8, rms=0.1, seed=seed, roll_off=1.5)

    lower = surface(80, 1)
    scans = {
        "pair": (scan(lower, 0.1), scan(lower + 0.2 * surface(80, 2) + 0.02, 0.1)),
        "flat.1": (scan(surface(48, 4), 0.1), None),
    }
    folder.mkdir(parents=True)
    parts = {stage: {} for stage in STAGES}
    settings = {name: resolve_unchecked(STUDY, name, {}, "tiny") for name in scans}
    for name, faces in scans.items():
        solver = solver_settings({}, "tiny")
        made = stages_of(name, faces, settings[name], solver)
        if name == "pair":
            settings[name], made = with_tests(made, settings[name], solver, folder)
        for stage, dataset in made.items():
            parts[stage][name] = dataset
    records = {name: asdict(stated) for name, stated in settings.items()}
    join_stages(parts, folder / "atlas.nc", {"study": STUDY, "settings": records})
    return settings


def write_pages(folder):
    """Write all pages of a study, as its jobs do; names of its specimens."""
    place = Place.of(folder)
    configuration = configuration_of(Trees(place.atlas, ()).root)
    shown = explored(configuration["study"], configuration["settings"])
    shown = shown if (place.folder / EXPLORER).is_file() else []
    write_specimen_pages(place, shown)
    return write_index(place, shown)
