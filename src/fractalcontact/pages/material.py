"""Material and opposite face of a specimen, in words."""

import math
from dataclasses import dataclass

from ..core.labels import printable
from ..core.subject import Subject
from .words import short, with_unit

#: The material stated for one specimen alone has this name in its settings.
_OWN = "own"
#: What stands for the other face, by the attribute ``opposite`` of the specimen.
_OPPOSITE = {
    "scanned": "both faces scanned",
    "match": "one face given, the other taken as its perfect match",
    "flat": "one face given, against a rigid plane",
    "aperture": "aperture map: the opening between both faces",
}


@dataclass(frozen=True)
class Material:
    """The material of both blocks.

    Attributes
    ----------
    name : str
        In the study; "own" if it was stated for this specimen. Untrusted text.
    modulus : float
        E, MPa.
    poisson : float
    hardness : float
        At which the pressure is capped, MPa; infinite where none is stated.
    """

    name: str
    modulus: float
    poisson: float
    hardness: float

    @property
    def words(self) -> str:
        """In a line: the name, E, Poisson's ratio and, if stated, the hardness."""
        name = "own material" if self.name == _OWN else f"material {printable(self.name)}"
        line = f"{name}: E = {with_unit(self.modulus, 'MPa')}, ν = {short(self.poisson)}"
        if math.isinf(self.hardness):
            return line
        return f"{line}, hardness {with_unit(self.hardness, 'MPa')}"


def material_of(subject: Subject) -> Material:
    """The material that the study, or the sidecar of a specimen, states."""
    stated = subject.settings["material"]
    return Material(
        name=str(stated["name"]),
        modulus=float(stated["modulus"]),
        poisson=float(stated["poisson"]),
        hardness=float(stated["hardness"]),
    )


def opposite_words(opposite: str) -> str:
    """Opposite face in words; ``opposite`` is the attribute of the specimen."""
    return _OPPOSITE[opposite]
