"""Settings of a specimen for tests that state only what they are about."""

from dataclasses import replace

from fractalcontact.study.configuration import resolve_settings

#: E* of 20 GPa.
STUDY = {
    "materials": {},
    "defaults": {
        "material": {"modulus": "38.4 GPa", "poisson": 0.2},
        "loads": ["1 MPa"],
        "resolutions": [1],
    },
}


def made_settings(**stated):
    """Settings that say this, as they are once resolved, and otherwise nothing of their own."""
    return replace(resolve_settings(STUDY, None, {}, "made"), **stated)
