"""A stage of a study: a group of the atlas, and the function that makes it."""

from dataclasses import dataclass

#: How often a stage is made: for every specimen, for those that slide, for those with an ensemble,
#: for those with laboratory tests, for every measured contact map; once, of all specimens together
#: (in the atlas, without a file); where the study has its key, once on synthetic surfaces, or as a
#: measurement of accuracy or speed, for every test problem or once.
SPECIMEN, JOINT, ENSEMBLE, MAP, STUDY = "specimen", "joint", "ensemble", "map", "study"
EXPERIMENT, MEASUREMENT, TESTED = "experiment", "measurement", "tested"
GRAINS = (SPECIMEN, JOINT, ENSEMBLE, TESTED, MAP, STUDY, EXPERIMENT, MEASUREMENT)


@dataclass(frozen=True)
class Stage:
    """One stage of a study: a group of the atlas, and a folder of the results.

    Attributes
    ----------
    name : str
        Of the group, the folder and, for an experiment, the key of the configuration.
    title : str
        What it holds: the description of its group.
    grain : str
        One of :data:`GRAINS`.
    function : str
        "package.room.module:function" that makes it. Stages of one function are made by one job.
    needs : tuple of str
        Stages whose datasets the function takes, as arguments of their names.
    member : str
        Wildcard or name that its files have, and its groups within the stage's.
    """

    name: str
    title: str
    grain: str
    function: str
    needs: tuple[str, ...] = ()
    member: str = "{specimen}"

    @property
    def path(self) -> str:
        """Its file, or the pattern of its files, below the folder of the results."""
        return f"{self.name}/{self.member}.nc"


def module_of(function: str) -> str:
    """File of "package.room.module:function" below the folder of the packages."""
    return f"{function.partition(':')[0].replace('.', '/')}.py"
