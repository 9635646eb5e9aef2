# Contact solves, the costly part. One job takes one specimen, and as many directions, offsets and
# resolutions as the study's `grain` says, with all their loads. And what follows from the states.
from collections.abc import Callable, Collection
from typing import NamedTuple


def parts_of(specimen):
    """Slices of directions, of offsets and of resolutions that the jobs of a specimen take."""
    settings = SETTINGS[specimen]
    return {
        "directions": grain("directions", len(settings.contact_directions)),
        # Where there are fewer offsets, a job without any writes an empty part.
        "offsets": grain("offsets", most_offsets(specimen)),
        "resolutions": grain("resolutions", len(settings.resolutions)),
    }


def part_of(wildcards, key):
    """The directions, offsets or resolutions that a contact job takes."""
    return parts_of(wildcards.specimen)[key][int(wildcards[key])]


rule contact:
    input:
        specimen=f"{RESULTS}/specimens/{{specimen}}.nc",
        joint=f"{RESULTS}/joints/{{specimen}}.nc",
    output:
        f"{RESULTS}/contact/{{specimen}}/{{directions}}.{{offsets}}.{{resolutions}}.nc",
    log:
        f"{RESULTS}/logs/contact/{{specimen}}/{{directions}}.{{offsets}}.{{resolutions}}.log",
    resources:
        **asked_for("contact"),
    params:
        function=stages.CONTACT,
        settings=settings_read_by(stages.CONTACT),
        directions=lambda wc: SETTINGS[wc.specimen].contact_directions[part_of(wc, "directions")],
        offsets=lambda wc: part_of(wc, "offsets"),
        resolutions=lambda wc: SETTINGS[wc.specimen].resolutions[part_of(wc, "resolutions")],
        code=code("stage", "fractalcontact/mechanics/sweep.py"),
    message:
        "{wildcards.specimen}: contact states, part {wildcards.directions}.{wildcards.offsets}.{wildcards.resolutions}"
    script:
        "../scripts/stage.py"


def contact_parts_of(specimen):
    """Files of the contact jobs of a specimen."""
    counts = {key: range(len(slices)) for key, slices in parts_of(specimen).items()}
    return expand(rules.contact.output, specimen=specimen, **counts)


def contact_parts(wildcards):
    """Files of the contact jobs of a specimen, as an input of stages that go through them."""
    return {"parts": contact_parts_of(wildcards.specimen)}


def ensemble_of(wildcards):
    """Files of the ensemble of a specimen; none where the study wants none."""
    return of_specimen(wildcards, ENSEMBLE)


def strength_of(wildcards):
    """Strength of a joint that slides; none of a surface against a plane."""
    return {key: path for key, path in of_specimen(wildcards, JOINT).items() if key == "strength"}


class StageJob(NamedTuple):
    """Job that calls the function of stages of a specimen, and what it has beside their entries."""

    stage: str  # one of those it makes
    words: str  # in the terminal
    resources: dict
    specimens: str = "[^/]+"  # pattern of those that have it
    inputs: Callable = lambda wildcards: {}  # beside the stages that it needs
    extra: dict = {}  # parameters
    grains: Collection = GRAINS  # of the stages that it makes
    priority: int = 0


#: Jobs, by the name of their rule, which is not that of a stage: "windows" makes window_states and
#: size_test, "strength" makes windows, strength and the statements.
STAGE_JOBS = {
    # The levelled specimen, and its joint before contact is solved: the dimension of its face, what
    # the instrument adds and which resolutions go below it, and one face slid over the other
    # (offsets, composite topographies, rigid dilatancy). Seconds of work, so one job.
    "specimen": StageJob(
        "specimens",
        "levelled scan, its surface dimension and its joint",
        asked_for("specimen", grid=0) | {"mem_mb": doubled(memory_of_reading)},
        inputs=scan_files,
        extra={"arguments": reading_of, "digests": scan_digests_of},
    ),
    # A measured map of contact goes straight to the analysis of domains.
    "contact_map": StageJob(
        "contact_maps",
        "measured contact map and its dimension",
        fixed(2000, 10),
        specimens=alternation(MAPS),
        inputs=scan_files,
        extra={
            "arguments": lambda wc: {
                "path": str(MAPS[wc.specimen].lower),
                "options": OPTIONS[wc.specimen],
                "label": LABELS[wc.specimen],
            },
            "digests": scan_digests_of,
        },
    ),
    # Closure curves and laws of area; box counts, dimension and clusters of every contact domain;
    # and the error of what is published, by source, for which some states are solved again on finer
    # grids and in other windows. Seconds of work, so one job.
    "analysis": StageJob(
        "closure",
        "closure, contact domains and their errors",
        asked_for("analysis"),
        inputs=lambda wc: contact_parts(wc) | ensemble_of(wc),
    ),
    # Sparse equations of all open cells, so a job of its own.
    "flow": StageJob(
        "flow", "aperture and transmissivity", asked_for("flow"), inputs=contact_parts
    ),
    # The longest of a specimen, and the others wait for it.
    "windows": StageJob(
        "window_states",
        "contact states of sub-windows, and eq. 6",
        asked_for("windows"),
        priority=1,
    ),
    # Its seed and those that follow, or twins. As long as the sub-windows; all but those wait for it.
    "ensemble": StageJob(
        "ensemble",
        "its ensemble",
        asked_for("ensemble", states=lambda wc: ENSEMBLES[wc.specimen]),
        specimens=alternation(ENSEMBLES),
        extra={
            "recipe": lambda wc: None if wc.specimen in TWINS else recipe_named(known(wc)),
            "realisations": lambda wc: ENSEMBLES[wc.specimen],
        },
        priority=2,
    ),
    # The report. These two alone read friction angles, wall strengths and labels, and solve nothing.
    "strength": StageJob(
        "windows",
        "strength, size laws and the paper's statements",
        asked_for("strength"),
        specimens=kind_of(SLIDING, FLAT),
        inputs=ensemble_of,
    ),
    "size_laws_against_plane": StageJob(
        "windows",
        "size laws and the paper's statements",
        asked_for("strength"),
        specimens=kind_of(FLAT, SLIDING),
        inputs=ensemble_of,
        grains=[SPECIMEN],
    ),
    # Little is solved: another hardness, or what has crushed under the largest pressure of a test.
    "measured": StageJob(
        "measured",
        "laboratory tests beside computed curves",
        asked_for("analysis"),
        inputs=strength_of,
        extra={"digests": lambda wc: digests_of(*(t.file for t in SETTINGS[known(wc)].measured))},
    ),
}
for NAME, JOB in STAGE_JOBS.items():

    rule:
        name:
            NAME
        input:
            unpack(JOB.inputs),
            **files_of(stages.needed_by(JOB.stage)),
        output:
            **files_of(stages.made_together(JOB.stage, JOB.grains)),
        log:
            f"{RESULTS}/logs/{NAME}/{{specimen}}.log",
        wildcard_constraints:
            specimen=JOB.specimens,
        priority: JOB.priority
        resources:
            **JOB.resources,
        params:
            **calling(JOB.stage),
            **JOB.extra,
        message:
            f"{{wildcards.specimen}}: {JOB.words}"
        script:
            "../scripts/stage.py"
