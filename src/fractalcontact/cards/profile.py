"""Card of one profile: its roughness, and why it has no contact."""

from typing import Any

import xarray as xr

from ..core.netcdf import versions
from ..core.subject import Subject
from ..core.text import compact
from .card import FORM, LICENCE
from .entries import entries, entry_of, rounded

_NO_CONTACT = "one profile has no contact: scan a face, or both"
_METHODS = (
    "The profile of {length} mm (spacing {spacing} mm) was levelled by its line. JRC is given "
    "by published fits to Z2, the rms slope over the step of each fit; Delta_g = 3 - H holds for "
    "an isotropic surface with such profiles, with H by the roughness length (Malinverno 1990). "
    "Computed with {versions}."
)
_REFERENCES = [
    "Malinverno, A. (1990): A simple method to estimate the fractal dimension of a self-affine "
    "series. Geophys. Res. Lett. 17, 1953-1956.",
    "Tse, R., Cruden, D. M. (1979): Estimating joint roughness coefficients. "
    "Int. J. Rock Mech. Min. Sci. 16, 303-307.",
]


class _Profile(Subject):
    """Profile as a specimen whose only state is its roughness."""

    def states(self, stage: str) -> xr.Dataset:
        """Stage itself: no state of it is selected."""
        return self[stage]


def card_of_profile(
    name: str, found: xr.Dataset, cells: int, spacing: float, checksum: str
) -> dict[str, Any]:
    """Card of a profile of some cells at a spacing (mm), whose file has this SHA-256.

    ``found`` is from :func:`joint.profile.profile_coefficients`.
    """
    subject = _Profile({"surface_dimension": found, "strength": found}, {"material": {}}, name)
    read = {row.name: entry_of(row, subject, "none") for row in entries()}
    for key, one in read.items():
        if key == "rms_slope" or one["section"] not in ("roughness", "material"):
            one["missing"] = _NO_CONTACT
    lengths = {"spacing": spacing, "length": cells * spacing}
    used = versions()
    return {
        "form": FORM,
        "name": name,
        "label": name,
        "study": "",
        "kind": "profile",
        "synthetic": False,
        "faces": "one profile",
        "material": "none",
        "model": "none: no contact",
        "direction": "none",
        "geometry": {key: {"value": rounded(one), "unit": "mm"} for key, one in lengths.items()},
        "entries": read,
        "errors": [],
        "lights": [],
        "trust": {
            "word": "limited",
            "reason": "roughness along one line alone",
            "help": "several profiles in the direction of sliding, or a scan of the face",
        },
        "methods": _METHODS.format(
            **{key: compact(one, 6) for key, one in lengths.items()},
            versions=", ".join(f"{of} {which}" for of, which in used.items()),
        ),
        "references": _REFERENCES,
        "licence": LICENCE,
        "versions": used,
        "scan_checksums": {"profile": checksum},
    }
