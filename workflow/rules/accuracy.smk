# How fast and how exact the solver, other solvers and cheaper models are: `snakemake accuracy`, a
# study of its own (config/accuracy.yaml), no part of `all`.
from contactlab.methods import registry
from fractalcontact.study.figure_list import accuracy_figures_of

TIMED = []
if "speed" in config:
    # Imported here, because no other study needs the solver to know its jobs.
    from contactlab.accuracy.reference import problems_of

    TIMED = list(problems_of(config["speed"]))

# Imported by name when they are called, and so not seen by `code` on its own.
METHOD_MODULES = [f"contactlab/methods/{module}" for module in registry.MODULES]
PROBLEMS = ["hertz", "punch", "richardson"] if "convergence" in config else []
# Installed later, they are measured later.
PEERS = list(registry.installed_peers())
# Kinds of problem that one job judges.
KINDS_A_JOB = 14
KINDS = []
if "stability" in config:
    from contactlab.accuracy.hard_problems import KINDS
PARTS = list(range(0, len(KINDS), KINDS_A_JOB))
ACCURACY_FIGURES = accuracy_figures_of(config)
ACCURACY_FILES = {}


# A clock is running: the job takes all cores, so that no other runs beside it.
rule speed:
    output:
        f"{RESULTS}/speed/{{case}}.nc",
    log:
        f"{RESULTS}/logs/speed/{{case}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/speed/{{case}}.tsv"
    wildcard_constraints:
        case=one_of(TIMED),
    threads: lambda wildcards: workflow.cores
    resources:
        mem_mb=doubled(4000),
        runtime=doubled(30),
    params:
        recipe=config.get("speed"),
        peers=PEERS,
        code=code("speed", *METHOD_MODULES),
    message:
        "speed: {wildcards.case}, by every solver and model"
    script:
        "../scripts/speed.py"


rule speed_growth:
    input:
        expand(rules.speed.output[0], case=TIMED),
    output:
        f"{RESULTS}/speed_growth/surfaces.nc",
    log:
        f"{RESULTS}/logs/speed_growth.log",
    benchmark:
        f"{RESULTS}/benchmarks/speed_growth.tsv"
    resources:
        mem_mb=doubled(1000),
        runtime=doubled(10),
    params:
        error=config.get("speed", {}).get("error"),
        code=code("speed_growth"),
    message:
        "speed: time over the size of surfaces"
    script:
        "../scripts/speed_growth.py"


rule convergence:
    output:
        f"{RESULTS}/convergence/{{problem}}.nc",
    log:
        f"{RESULTS}/logs/convergence/{{problem}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/convergence/{{problem}}.tsv"
    wildcard_constraints:
        problem=one_of(PROBLEMS),
    resources:
        mem_mb=doubled(1000),
        runtime=doubled(30),
    params:
        recipe=config.get("convergence"),
        code=code("convergence"),
    message:
        "convergence: {wildcards.problem}, compared with the exact solution"
    script:
        "../scripts/convergence.py"


rule stability_part:
    output:
        f"{RESULTS}/stability/{{part}}.nc",
    log:
        f"{RESULTS}/logs/stability/{{part}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/stability/{{part}}.tsv"
    resources:
        mem_mb=doubled(1500),
        runtime=doubled(60),
    params:
        kinds=lambda wc: list(KINDS)[int(wc.part) : int(wc.part) + KINDS_A_JOB],
        draws=config.get("stability", {}).get("draws"),
        peers=PEERS,
        code=code("stability_part", *METHOD_MODULES),
    message:
        "stability: hard test problems from kind {wildcards.part} on"
    script:
        "../scripts/stability_part.py"


rule stability:
    input:
        expand(rules.stability_part.output[0], part=PARTS),
    output:
        f"{RESULTS}/stability/scenes.nc",
    log:
        f"{RESULTS}/logs/stability.log",
    benchmark:
        f"{RESULTS}/benchmarks/stability.tsv"
    resources:
        mem_mb=doubled(1000),
        runtime=doubled(10),
    params:
        code=code("stability"),
    message:
        "stability: verdicts over all hard test problems"
    script:
        "../scripts/stability.py"


rule elimination:
    output:
        f"{RESULTS}/elimination/scenes.nc",
    log:
        f"{RESULTS}/logs/elimination.log",
    benchmark:
        f"{RESULTS}/benchmarks/elimination.tsv"
    resources:
        mem_mb=doubled(1000),
        runtime=doubled(30),
    params:
        draws=config.get("stability", {}).get("elimination"),
        code=code("elimination", *METHOD_MODULES),
    message:
        "stability: elimination of nodes in tension alone, as the paper does"
    script:
        "../scripts/elimination.py"


if TIMED:
    ACCURACY_FILES["speed"] = expand(rules.speed.output[0], case=TIMED)
    ACCURACY_FILES["speed_growth"] = rules.speed_growth.output[0]
if PROBLEMS:
    ACCURACY_FILES["convergence"] = expand(rules.convergence.output[0], problem=PROBLEMS)
if PARTS:
    ACCURACY_FILES["stability"] = rules.stability.output[0]
    ACCURACY_FILES["elimination"] = rules.elimination.output[0]


rule accuracy_atlas:
    input:
        **ACCURACY_FILES,
    output:
        f"{RESULTS}/accuracy.nc",
    log:
        f"{RESULTS}/logs/accuracy_atlas.log",
    benchmark:
        f"{RESULTS}/benchmarks/accuracy_atlas.tsv"
    resources:
        mem_mb=doubled(1000),
        runtime=doubled(10),
    params:
        configuration={"study": config, "settings": {}},
        code=code("atlas"),
    message:
        "accuracy: all measurements in one file"
    script:
        "../scripts/atlas.py"


# Drawn as the figures of any study are, from an atlas of its own.
use rule study_figures as accuracy_figures with:
    input:
        rules.accuracy_atlas.output[0],
    output:
        *[picture(name, folder="", category="accuracy") for name in ACCURACY_FIGURES],
        *expand(
            f"{RESULTS}/figures/{{name}}.{{ending}}",
            name=ACCURACY_FIGURES,
            ending=("svg", "csv", "txt"),
        ),
        undrawn=f"{RESULTS}/undrawn_of_accuracy.txt",
    log:
        f"{RESULTS}/logs/accuracy_figures.log",
    benchmark:
        f"{RESULTS}/benchmarks/accuracy_figures.tsv"
    params:
        specimens=[],
        names=ACCURACY_FIGURES,
        code=code("study_figures", *figure_modules(ACCURACY_FIGURES)),
    message:
        "accuracy: figures"


use rule all_drawn as accuracy_drawn with:
    input:
        undrawn=[rules.accuracy_figures.output.undrawn],
    output:
        f"{RESULTS}/all_drawn_of_accuracy.txt",
    log:
        f"{RESULTS}/logs/accuracy_drawn.log",
    benchmark:
        f"{RESULTS}/benchmarks/accuracy_drawn.tsv"
    params:
        logs=f"{RESULTS}/logs/accuracy_figures.log",
        code=code("all_drawn"),


def accuracy_pictures(wildcards):
    if not ACCURACY_FIGURES:
        raise WorkflowError(
            f"{SOURCE}: no key 'speed', 'convergence' or 'stability', so nothing to measure; "
            "give --configfile config/accuracy.yaml"
        )
    parts = expand(rules.stability_part.output[0], part=PARTS)
    return [
        *rules.accuracy_figures.output,
        *rules.accuracy_drawn.output,
        *rules.accuracy_atlas.output,
        *rules.accuracy_atlas.input,
        *parts,
    ]


rule accuracy:
    input:
        accuracy_pictures,
    message:
        "accuracy: all measurements and figures"
