# Figures of specimens and of the study: PNG, SVG, numbers as CSV, caption as text.
from fractalcontact.study.figure_list import all_figures, study_figures_of
from fractalcontact.study.selection import CAPPED_VARIANTS

# Keys that ask for figures of the study: its own keys, and one each for contact maps, for several specimens,
# and for surfaces that the study has with and without a hardness.
ASKED = [*config, *(["contact_maps"] if MAPS else [])]
if len(SPECIMENS) > 1:
    ASKED.append(campaign.COMPARISON)
if any(record["capped_variant"] for record in RECORDS.values()):
    ASKED.append(CAPPED_VARIANTS)
STUDY_FIGURES = study_figures_of(ASKED)
if CAMPAIGN:
    STUDY_FIGURES = campaign.of_study_alone(STUDY_FIGURES)
#: Names of the figures that the study asks for, of each joint (`match` stands for every kind of joint) and of
#: each specimen that does not slide.
OF_JOINT = campaign.drawn_of(config, SPECIMENS, "match")
OF_FLAT = campaign.drawn_of(config, SPECIMENS, "flat")


def drawings(names, folder="{specimen}/", category="{specimen}"):
    """Files of figures, each PNG with its title for the report.

    `update` keeps the old files until the new ones are complete (see the rule `atlas`).
    """
    files = {name: f"{RESULTS}/figures/{folder}{name}" for name in names}
    endings = "svg", "csv", "txt"
    found = [update(f"{file}.{ending}") for file in files.values() for ending in endings]
    for name, file in files.items():
        labels = {"figure": name, "title": all_figures()[name].title}
        # At the beginning of a line, `report` would be read as the directive.
        found.append(report(update(f"{file}.png"), category=category, labels=labels))
    return found


#: List of the figures that failed. It is empty unless the program has an error.
UNDRAWN = f"{RESULTS}/undrawn/{{specimen}}.txt"
#: Digest of what each figure was drawn from: a figure whose digest stays is not drawn again.
DRAWN_FROM = f"{RESULTS}/drawn_from/{{specimen}}.txt"


# Figures of one specimen. `update` leaves the old ones in place, and the job draws those alone whose numbers,
# settings or code changed.
rule figures:
    input:
        SPECIMEN_ATLAS,
    output:
        *drawings(OF_JOINT),
        undrawn=UNDRAWN,
        drawn_from=update(DRAWN_FROM),
    log:
        f"{RESULTS}/logs/figures/{{specimen}}.log",
    wildcard_constraints:
        specimen=names_of(SLIDING, FLAT),
    priority: PRIORITY["figures"]
    resources:
        mem_mb=memory("figures"),
        runtime=minutes("figures"),
    params:
        names=OF_JOINT,
        code=code("figures", "fractalcontact/figures"),
    message:
        "{wildcards.specimen}: figures"
    script:
        "../scripts/figures.py"


# The same for a specimen that does not slide, with fewer figures. Memory and time are those of `figures`.
use rule figures as figures_against_plane with:
    output:
        *drawings(OF_FLAT),
        undrawn=UNDRAWN,
        drawn_from=update(DRAWN_FROM),
    log:
        f"{RESULTS}/logs/figures_against_plane/{{specimen}}.log",
    wildcard_constraints:
        specimen=names_of(FLAT, SLIDING),
    priority: PRIORITY["figures_against_plane"]
    params:
        names=OF_FLAT,
        code=code("figures", "fractalcontact/figures"),


# Figures that compare all specimens, or show experiments.
rule study_figures:
    input:
        rules.atlas.output[0],
    output:
        *drawings(STUDY_FIGURES, folder="", category="study"),
        undrawn=f"{RESULTS}/undrawn_of_study.txt",
    log:
        f"{RESULTS}/logs/study_figures.log",
    resources:
        mem_mb=doubled(4000),
        runtime=doubled(10),
    params:
        specimens=SPECIMENS,
        names=STUDY_FIGURES,
        code=code("study_figures", "fractalcontact/figures", "contactlab/figures"),
    message:
        "the study: figures over all specimens"
    script:
        "../scripts/study_figures.py"


#: Specimens of which the study draws any figure.
DRAWN = [name for name in SPECIMENS if (OF_JOINT if name in SLIDING else OF_FLAT)]


# A figure that fails stops no other figure. This job then fails, and names those that failed.
rule all_drawn:
    input:
        undrawn=[
            *expand(UNDRAWN, specimen=DRAWN),
            *([rules.study_figures.output.undrawn] if STUDY_FIGURES else []),
        ],
        # The job waits for the atlas, because Snakemake begins no further job once one has failed.
        atlas=rules.atlas.output[0],
    output:
        f"{RESULTS}/all_drawn.txt",
    log:
        f"{RESULTS}/logs/all_drawn.log",
    resources:
        mem_mb=doubled(500),
        runtime=doubled(5),
    params:
        logs=f"{RESULTS}/logs",
        code=code("all_drawn"),
    message:
        "the study: whether all figures were drawn"
    script:
        "../scripts/all_drawn.py"


#: Endings of the files of a figure: pictures, numbers, caption.
ENDINGS = ("png", "svg", "csv", "txt")


def figure_files(specimen, endings=ENDINGS):
    """Files of the figures of a specimen with these endings."""
    names = OF_JOINT if specimen in SLIDING else OF_FLAT
    return expand(f"{RESULTS}/figures/{specimen}/{{name}}.{{ending}}", name=names, ending=endings)


def all_figure_files(endings=ENDINGS):
    """Files of all figures of the study and of its specimens with these endings."""
    of_study = expand(f"{RESULTS}/figures/{{name}}.{{ending}}", name=STUDY_FIGURES, ending=endings)
    return [*of_study, *(path for name in SPECIMENS for path in figure_files(name, endings))]


def collect_everything(wildcards):
    """Every file of the study, so that one that was removed or set aside is made again.

    A campaign does not ask for the files behind its atlas: to find that nothing is to be done would
    take minutes.
    """
    drawn = [*rules.all_drawn.output, *rules.all_drawn.input.undrawn, *all_figure_files()]
    made = [*LABORATORY, *drawn, *RESULT_PAGE]
    if CAMPAIGN:
        return made
    return [
        *made,
        *STAGE_FILES,
        *MAP_FILES,
        *(path for name in SPECIMENS for path in contact_files_of(name)),
        *expand(rules.synthetic_scan.output, specimen=set(SPECIMENS) - set(SCANS)),
        *expand(SPECIMEN_ATLAS, specimen=SPECIMENS),
    ]
