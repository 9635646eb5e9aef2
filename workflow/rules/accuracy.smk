# How fast and how exact the solver, other solvers and cheaper models are: `snakemake accuracy`, a
# study of its own (config/accuracy.yaml), no part of `all`.
from contactlab.methods import registry
from fractalcontact.study.figure_list import accuracy_figures_of

TIMED = []
if "speed" in config:
    # Imported here, because no other study needs the solver to know its jobs.
    from contactlab.accuracy.reference import problems_of

    TIMED = list(problems_of(config["speed"]))

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
#: What is measured job by job, by the file that it gives: a function and its arguments.
MEASURED = {
    **{
        f"convergence/{problem}": (
            "contactlab.accuracy.stage:convergence",
            {"problem": problem, "recipe": config["convergence"]},
        )
        for problem in PROBLEMS
    },
    **{
        f"stability/{part}": (
            "contactlab.accuracy.stability:stability",
            {
                "kinds": list(KINDS)[part : part + KINDS_A_JOB],
                "draws": config["stability"]["draws"],
            },
        )
        for part in PARTS
    },
}
if PARTS:
    draws = {"draws": config["stability"]["elimination"]}
    MEASURED["elimination/scenes"] = ("contactlab.accuracy.elimination:elimination", draws)


# A clock is running: the job takes all cores, so that no other runs beside it.
rule speed:
    output:
        f"{RESULTS}/speed/{{case}}.nc",
    log:
        f"{RESULTS}/logs/speed/{{case}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/speed/{{case}}.tsv"
    wildcard_constraints:
        case=alternation(TIMED),
    threads: lambda wildcards: workflow.cores
    resources:
        **fixed(4000, 30),
    params:
        recipe=config.get("speed"),
        peers=PEERS,
        code=code("speed", "contactlab/methods"),
    message:
        "speed: {wildcards.case}, by every solver and model"
    script:
        "../scripts/speed.py"


rule speed_growth:
    input:
        problems=expand(rules.speed.output[0], case=TIMED),
    output:
        f"{RESULTS}/speed_growth/surfaces.nc",
    log:
        f"{RESULTS}/logs/speed_growth.log",
    benchmark:
        f"{RESULTS}/benchmarks/speed_growth.tsv"
    resources:
        **fixed(1000, 10),
    params:
        **calling("speed_growth"),
        error=config.get("speed", {}).get("error"),
    message:
        "speed: time over the size of surfaces"
    script:
        "../scripts/stage.py"


rule measurement:
    output:
        f"{RESULTS}/{{measured}}.nc",
    log:
        f"{RESULTS}/logs/{{measured}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/{{measured}}.tsv"
    wildcard_constraints:
        measured=alternation(MEASURED),
    resources:
        **fixed(1500, 60),
    params:
        function=lambda wc: MEASURED[wc.measured][0],
        arguments=lambda wc: MEASURED[wc.measured][1],
        peers=lambda wc: PEERS if "stability" in wc.measured else [],
        code=code("stage", "contactlab/accuracy", "contactlab/methods"),
    message:
        "accuracy: {wildcards.measured}"
    script:
        "../scripts/stage.py"


rule stability:
    input:
        parts=expand(rules.measurement.output[0], measured=[f"stability/{part}" for part in PARTS]),
    output:
        f"{RESULTS}/stability/scenes.nc",
    log:
        f"{RESULTS}/logs/stability.log",
    benchmark:
        f"{RESULTS}/benchmarks/stability.tsv"
    resources:
        **fixed(1000, 10),
    params:
        **calling("stability"),
    message:
        "stability: verdicts over all hard test problems"
    script:
        "../scripts/stage.py"


if TIMED:
    ACCURACY_FILES["speed"] = expand(rules.speed.output[0], case=TIMED)
    ACCURACY_FILES["speed_growth"] = rules.speed_growth.output[0]
if PROBLEMS:
    ACCURACY_FILES["convergence"] = [f"{RESULTS}/convergence/{problem}.nc" for problem in PROBLEMS]
if PARTS:
    ACCURACY_FILES["stability"] = rules.stability.output[0]
    ACCURACY_FILES["elimination"] = f"{RESULTS}/elimination/scenes.nc"


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
        **fixed(1000, 10),
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
        code=code("figures", "fractalcontact/figures", "contactlab/figures"),
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
    return [
        *rules.accuracy_figures.output,
        *rules.accuracy_drawn.output,
        *rules.accuracy_atlas.output,
        *rules.accuracy_atlas.input,
        *rules.stability.input,
    ]


rule accuracy:
    input:
        accuracy_pictures,
    message:
        "accuracy: all measurements and figures"
