# Figures of every specimen: PNG, SVG, numbers as CSV, caption as text.
from fractalcontact.study.figure_list import all_figures, study_figures_of
from fractalcontact.study.selection import CAPPED_VARIANTS

# Measured contact maps ask for their figures themselves, and so do several specimens.
ASKED = [*config, *(["contact_maps"] if MAPS else [])]
if len(SPECIMENS) > 1:
    ASKED.append(campaign.COMPARISON)
if any(record["capped_variant"] for record in RECORDS.values()):
    ASKED.append(CAPPED_VARIANTS)
STUDY_FIGURES = study_figures_of(ASKED)
if IN_PARTS:
    STUDY_FIGURES = campaign.of_study_alone(STUDY_FIGURES)
#: Names of the figures of each joint (of matching or independent faces), and of each surface against a plane, that the study asks for.
OF_JOINT = campaign.drawn_of(config, SPECIMENS, "match")
OF_FLAT = campaign.drawn_of(config, SPECIMENS, "flat")


def drawings(names, folder="{specimen}/", category="{specimen}"):
    """Files of figures: each PNG with its title for the report, and what goes with it.

    Those that are there stay until the new ones take their places.
    """
    files = {name: f"{RESULTS}/figures/{folder}{name}" for name in names}
    endings = "svg", "csv", "txt"
    found = [update(f"{file}.{ending}") for file in files.values() for ending in endings]
    for name, file in files.items():
        labels = {"figure": name, "title": all_figures()[name].title}
        # At the beginning of a line, `report` would be read as the directive.
        found.append(report(update(f"{file}.png"), category=category, labels=labels))
    return found


def configuration_of(wildcards):
    """What the atlas of one specimen says of the study: what the study says of others is left out.

    So a change of those draws nothing of it again.
    """
    name = known(wildcards)
    stated = {key: config[key] for key in ("study", "accuracy", "solver") if key in config}
    if name in config.get("embedded", {}):
        stated["embedded"] = {name: config["embedded"][name]}
    return {"study": stated, "settings": {name: RECORDS[name]}}


#: Names of the figures that failed, which is empty but for an error of the program.
UNDRAWN = f"{RESULTS}/undrawn/{{specimen}}.txt"


# This job first writes the atlas of one specimen (and its row, in a campaign), and draws from that: it
# needs no atlas.nc. So a new scan draws only its own figures, and one bad scan does not keep the others
# from theirs. A new contact map draws all again, as it stands beside every specimen.
rule figures:
    input:
        STAGE_PATTERNS,
        rules.strength.output,
        ENSEMBLE,
        branch(lambda wildcards: wildcards.specimen in TESTED, then=rules.measured.output.measured),
        [] if IN_PARTS else MAP_FILES,
    output:
        *drawings(OF_JOINT),
        **({"row": SPECIMEN_ROW} if IN_PARTS else {}),
        atlas=update(SPECIMEN_ATLAS),
        undrawn=UNDRAWN,
    log:
        f"{RESULTS}/logs/figures/{{specimen}}.log",
    wildcard_constraints:
        specimen=names_of(SLIDING, FLAT),
    # After what the atlas of the study waits for: else, at the end, one core draws from it alone.
    # The longer jobs first. Of a campaign nobody wants to wait that long.
    priority: 0 if IN_PARTS else -2
    resources:
        mem_mb=memory("figures" if OF_JOINT else "atlas_part"),
        runtime=minutes("figures" if OF_JOINT else "atlas_part"),
    params:
        names=OF_JOINT,
        configuration=configuration_of,
        code=code("figures", "fractalcontact/figures"),
    message:
        "{wildcards.specimen}: figures"
    script:
        "../scripts/figures.py"


# A surface against a plane does not slide: no strength, and fewer figures.
use rule figures as figures_against_plane with:
    input:
        STAGE_PATTERNS,
        rules.size_laws_against_plane.output,
        ENSEMBLE,
        branch(lambda wildcards: wildcards.specimen in TESTED, then=rules.measured.output.measured),
        [] if IN_PARTS else MAP_FILES,
    output:
        *drawings(OF_FLAT),
        **({"row": SPECIMEN_ROW} if IN_PARTS else {}),
        atlas=update(SPECIMEN_ATLAS),
        undrawn=UNDRAWN,
    log:
        f"{RESULTS}/logs/figures_against_plane/{{specimen}}.log",
    wildcard_constraints:
        specimen=names_of(FLAT, SLIDING),
    priority: 0 if IN_PARTS else -3
    params:
        names=OF_FLAT,
        configuration=configuration_of,
        code=code("figures", "fractalcontact/figures"),


# What only the whole study shows.
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


# A figure that fails keeps no other from being drawn, of this specimen or another; but the study has
# not succeeded, and ends here with the names of those that failed.
rule all_drawn:
    input:
        undrawn=[
            *expand(UNDRAWN, specimen=SPECIMENS),
            *([rules.study_figures.output.undrawn] if STUDY_FIGURES else []),
        ],
        # Not before everything else is there: a job that fails keeps others from being begun.
        atlas=rules.atlas.output[0],
    output:
        f"{RESULTS}/all_drawn.txt",
    log:
        f"{RESULTS}/logs/all_drawn.log",
    resources:
        mem_mb=doubled(500),
        runtime=doubled(5),
    params:
        reason="not drawn, because of an error of the program: NAMES; their pictures say so, the "
        f"logs in {RESULTS}/logs/figures hold the whole error; everything else is done",
        code=code("refused"),
    message:
        "the study: whether all figures were drawn"
    script:
        "../scripts/refused.py"


def figure_files(specimen, endings=("png", "svg", "csv", "txt")):
    """Files of the figures of a specimen, that one which is removed is made again."""
    names = OF_JOINT if specimen in SLIDING else OF_FLAT
    files = [f"{RESULTS}/figures/{specimen}/{name}" for name in names]
    return [f"{file}.{ending}" for file in files for ending in endings]


def all_figure_files():
    """Every file of the figures of a study."""
    of_specimens = [path for specimen in SPECIMENS for path in figure_files(specimen)]
    return [*(rules.study_figures.output if STUDY_FIGURES else []), *of_specimens]


def collect_everything(wildcards):
    """Every file of the study: what was removed, or damaged and so removed, is made again.

    Of a campaign what its atlas is made of is not asked for, file by file: it would take minutes to
    find that nothing is to be done.
    """
    made = [*LABORATORY, *rules.all_drawn.output, *all_figure_files(), *RESULT_PAGE]
    if IN_PARTS:
        return made
    return [
        *made,
        *STAGE_FILES,
        *MAP_FILES,
        *(path for name in SPECIMENS for path in contact_files_of(name)),
        *expand(list(rules.synthetic_scan.output), specimen=set(SPECIMENS) - set(SCANS)),
        *expand(SPECIMEN_ATLAS, specimen=SPECIMENS),
    ]
