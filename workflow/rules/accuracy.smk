# How fast and how exact the solver, other solvers and cheaper models are: `snakemake accuracy`, a
# study of its own (config/accuracy.yaml), no part of `all`.
from typing import NamedTuple

from fractalcontact.study.figure_list import accuracy_figures_of

# What needs the solver is imported where a study has the keys: no other needs it to know its jobs.
TIMED = []
if "speed" in config:
    from contactlab.accuracy.reference import problems_of

    TIMED = list(problems_of(config["speed"]))

PROBLEMS = ["hertz", "punch", "richardson"] if "convergence" in config else []
# Installed later, they are measured later.
PEERS = []
if config.keys() & {"speed", "stability"}:
    from contactlab.methods.registry import installed_peers

    PEERS = list(installed_peers())
# Kinds of problem that one job judges.
KINDS_A_JOB = 14
KINDS = []
if "stability" in config:
    from contactlab.accuracy.hard_problems import KINDS
PARTS = list(range(0, len(KINDS), KINDS_A_JOB))
ACCURACY_FIGURES = accuracy_figures_of(config)


class Measurement(NamedTuple):
    """Function, what it is given, and the files of others that it takes."""

    function: str
    arguments: dict
    inputs: dict = {}


#: Measurements, by the file that is made. One job judges some kinds of hard problems, another joins
#: them.
STABILITY = {
    f"stability/{part}": Measurement(
        "contactlab.accuracy.stability:stability",
        {"kinds": list(KINDS)[part : part + KINDS_A_JOB], "draws": config["stability"]["draws"]},
    )
    for part in PARTS
}
MEASURED = STABILITY | {
    f"convergence/{problem}": Measurement(
        "contactlab.accuracy.stage:convergence",
        {"problem": problem, "recipe": config["convergence"]},
    )
    for problem in PROBLEMS
}
if PARTS:
    MEASURED["stability/scenes"] = Measurement(
        stages.STAGES["stability"].function,
        {},
        {"parts": [f"{RESULTS}/{part}.nc" for part in STABILITY]},
    )
    MEASURED["elimination/scenes"] = Measurement(
        stages.STAGES["elimination"].function,
        {"draws": config["stability"]["elimination"]},
    )
if TIMED:
    MEASURED["speed_growth/surfaces"] = Measurement(
        stages.STAGES["speed_growth"].function,
        {"error": config["speed"]["error"]},
        {"problems": expand(f"{RESULTS}/speed/{{case}}.nc", case=TIMED)},
    )


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


rule measurement:
    input:
        unpack(lambda wc: MEASURED[wc.measured].inputs),
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
        function=lambda wc: MEASURED[wc.measured].function,
        arguments=lambda wc: MEASURED[wc.measured].arguments,
        peers=lambda wc: PEERS if wc.measured in STABILITY else [],
        code=code("stage", "contactlab/accuracy", "contactlab/methods"),
    message:
        "accuracy: {wildcards.measured}"
    script:
        "../scripts/stage.py"


ACCURACY_FILES = {"speed": expand(rules.speed.output[0], case=TIMED)} if TIMED else {}
for measured in MEASURED:
    if measured not in STABILITY:
        stage = measured.partition("/")[0]
        ACCURACY_FILES.setdefault(stage, []).append(f"{RESULTS}/{measured}.nc")


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
        *drawings(ACCURACY_FIGURES, folder="", category="accuracy"),
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
        *(f"{RESULTS}/{part}.nc" for part in STABILITY),
    ]


rule accuracy:
    input:
        accuracy_pictures,
    message:
        "accuracy: all measurements and figures"
