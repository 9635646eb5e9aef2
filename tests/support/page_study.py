"""A study with a result page: a hostile label, and few nodes in contact at the smallest load."""

from materials import ROCK
from spreadsheets import FORMULA

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
