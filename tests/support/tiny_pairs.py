"""A pair of rough faces of 48 x 48 cells, solved in milliseconds, and its study."""

from samples import scan_of

from fractalcontact.states.loading import JointLoading
from fractalcontact.study.configuration import resolve_settings, solver_settings
from fractalcontact.surface.specimen import make_specimen, window_arguments
from fractalcontact.surface.synthesis import self_affine

STUDY = {
    "study": "tiny",
    "materials": {"rock": {"modulus": "20 GPa", "poisson": 0.2}},
    "defaults": {
        "material": "rock",
        "contact_directions": ["E"],
        "loads": ["1 MPa", "25 MPa"],
        "resolutions": [1],
        "window": "16 mm",
    },
}
SETTINGS = resolve_settings(STUDY, "rock", {}, "tiny")


def pair(level=0.0):
    """Specimen of both faces, the upper one higher by a level (mm)."""
    z = self_affine((48, 48), 0.5, 0.8, rms=0.5, seed=1)
    upper = z + 0.1 * self_affine((48, 48), 0.5, 0.8, rms=0.5, seed=2)
    faces = scan_of(z), scan_of(upper + 0.5 + level)
    return make_specimen(*faces, name="rock", **window_arguments(SETTINGS))


def loading_of(specimen):
    """Its loading at no offset."""
    return JointLoading(specimen, "E", 0, SETTINGS, solver_settings({}, "tiny")).at(0)
