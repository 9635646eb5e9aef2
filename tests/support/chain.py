"""The whole chain of a specimen as calls: what the jobs of a study compute, one after the other."""

from dataclasses import asdict

from made_stages import stages_of_specimen
from materials import ROCK

from fractalcontact.figures.draw import draw_figures
from fractalcontact.stages.atlas import join_stages
from fractalcontact.stages.specimen import specimen_of_files
from fractalcontact.study.configuration import resolve_settings, solver_settings
from fractalcontact.study.figure_list import figures_of
from fractalcontact.study.scan_files import ScanFiles

SOLVER = solver_settings({}, "tiny")


#: As small as a study can be that still has every figure.
SMALL_STUDY = {
    "study": "small",
    "materials": {"rock": ROCK},
    "defaults": {
        "material": "rock",
        "directions": ["E", "W"],
        "contact_directions": ["W"],
        "loads": ["1 MPa", "10 MPa", "100 MPa"],
        "resolutions": [1, 2],
    },
}


def atlas_of_scan(lower, upper, options, folder, settings=(), name="specimen"):
    """Scan files of a specimen through all stages into an atlas.

    Returns
    -------
    path : Path
        The atlas.
    opposite : str
    """
    own = dict(settings)
    scan = ScanFiles(name, lower, upper, None)
    resolved = resolve_settings(SMALL_STUDY, name, own, "small", scan)
    files = [lower] if upper is None else [lower, upper]
    specimen = specimen_of_files(files, options, resolved, name)
    parts = {
        stage: {name: data}
        for stage, data in stages_of_specimen(specimen, resolved, SOLVER).items()
    }
    path = folder / "atlas.nc"
    join_stages(parts, path, {"study": SMALL_STUDY, "settings": {name: asdict(resolved)}})
    return path, resolved.opposite


def draw_scan(atlas, opposite, folder, name="specimen"):
    """All figures of a specimen, drawn to a folder; their captions by name."""
    return draw_figures(atlas, name, folder, figures_of(opposite))
