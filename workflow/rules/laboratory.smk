# Experiments on synthetic surfaces, and speed and accuracy of the solver. Each is made where the study has
# its key.
from contactlab.experiments.size_tasks import size_jobs
from fractalcontact.study.configuration import resolve_roll_off

try:
    ROLL_OFF = resolve_roll_off(config, SOURCE) if "roll_off" in config else {}
    SIZE_PARTS = size_jobs(config["size_effect"]) if "size_effect" in config else {}
except InputError as error:
    raise WorkflowError(str(error))

SCENES, KINDS, PEERS = [], [], []
if {"speed", "stability"} & set(config):
    # These imports load the solvers and take long.
    from contactlab.accuracy.hard_problems import KINDS as ALL_KINDS
    from contactlab.accuracy.reference import problems_of
    from contactlab.methods.registry import installed_peers

    SCENES = list(problems_of(config["speed"])) if "speed" in config else []
    KINDS = list(ALL_KINDS) if "stability" in config else []
    #: Other codes that are measured. They are a parameter, so that a code installed later makes the
    #: jobs run again.
    PEERS = list(installed_peers())
#: Kinds of hard problem that one job judges.
KINDS_A_JOB = 14


def recipe_of(experiment):
    """Parameter with the recipe of an experiment, as the study states it."""
    return lambda wildcards: config[experiment]


rule roll_off:
    output:
        f"{RESULTS}/roll_off/surfaces.nc",
    log:
        f"{RESULTS}/logs/roll_off/surfaces.log",
    priority: PRIORITY["roll_off"]
    resources:
        mem_mb=doubled(4000),
        runtime=doubled(30),
    params:
        arguments=ROLL_OFF,
        code=code("roll_off"),
    message:
        "laboratory: rigid dilatancy with and without a roll-off"
    script:
        "../scripts/roll_off.py"


rule size_strength:
    output:
        f"{RESULTS}/size_strength/surfaces.nc",
    log:
        f"{RESULTS}/logs/size_strength/surfaces.log",
    priority: PRIORITY["size_strength"]
    resources:
        mem_mb=doubled(4000),
        runtime=doubled(120),
    params:
        recipe=recipe_of("size_strength"),
        rtol=SOLVER["rtol"],
        code=code("size_strength"),
    message:
        "laboratory: strength of sliding joints over their side"
    script:
        "../scripts/size_strength.py"


rule area_slope:
    output:
        f"{RESULTS}/area_slope/surfaces.nc",
    log:
        f"{RESULTS}/logs/area_slope/surfaces.log",
    priority: PRIORITY["area_slope"]
    resources:
        mem_mb=doubled(4000),
        runtime=doubled(60),
    params:
        recipe=recipe_of("area_slope"),
        rtol=SOLVER["rtol"],
        code=code("area_slope"),
    message:
        "laboratory: real contact area at light load"
    script:
        "../scripts/area_slope.py"


rule estimator_bias:
    output:
        f"{RESULTS}/estimator_bias/surfaces.nc",
    log:
        f"{RESULTS}/logs/estimator_bias/surfaces.log",
    priority: PRIORITY["estimator_bias"]
    resources:
        mem_mb=doubled(4000),
        runtime=doubled(60),
    params:
        recipe=recipe_of("estimator_bias"),
        code=code("estimator_bias"),
    message:
        "laboratory: bias of the estimators of Delta_g"
    script:
        "../scripts/estimator_bias.py"


def memory_of_part(wildcards):
    """Megabytes of a part of the experiment on the size effect, by its largest surface."""
    side = max(task.whole or task.size for task in SIZE_PARTS[wildcards.part])
    return estimates.memory("size_effect_part", side**2)


# Surfaces of one class a job, which takes minutes; small classes share a job. The order does not matter.
rule size_effect_part:
    output:
        f"{RESULTS}/size_effect_parts/{{part}}.nc",
    log:
        f"{RESULTS}/logs/size_effect_parts/{{part}}.log",
    wildcard_constraints:
        part=alternation(SIZE_PARTS),
    priority: PRIORITY["size_effect_part"]
    resources:
        mem_mb=doubled(memory_of_part),
        runtime=doubled(60),
    params:
        tasks=lambda wildcards: [*map(list, SIZE_PARTS[wildcards.part])],
        loads=lambda wildcards: config["size_effect"]["loads"],
        rtol=SOLVER["rtol"],
        code=code("size_effect_part"),
    message:
        "laboratory: size effect, surfaces {wildcards.part}"
    script:
        "../scripts/size_effect_part.py"


rule size_effect:
    input:
        parts=expand(rules.size_effect_part.output, part=SIZE_PARTS),
    output:
        f"{RESULTS}/size_effect/surfaces.nc",
    log:
        f"{RESULTS}/logs/size_effect/surfaces.log",
    resources:
        mem_mb=doubled(2000),
        runtime=doubled(20),
    params:
        recipe=recipe_of("size_effect"),
        code=code("size_effect"),
    message:
        "laboratory: which exponent carries the size effect"
    script:
        "../scripts/size_effect.py"


# The job measures time. It takes all cores, so that no other job disturbs it.
rule speed:
    output:
        f"{RESULTS}/speed/{{scene}}.nc",
    log:
        f"{RESULTS}/logs/speed/{{scene}}.log",
    wildcard_constraints:
        scene=alternation(SCENES),
    threads: lambda wildcards: workflow.cores
    resources:
        mem_mb=doubled(4000),
        runtime=doubled(30),
    params:
        recipe=recipe_of("speed"),
        peers=PEERS,
        code=code("speed"),
    message:
        "laboratory: error against time, {wildcards.scene}"
    script:
        "../scripts/speed.py"


rule speed_growth:
    input:
        problems=expand(rules.speed.output, scene=SCENES),
    output:
        f"{RESULTS}/speed_growth/surfaces.nc",
    log:
        f"{RESULTS}/logs/speed_growth/surfaces.log",
    resources:
        mem_mb=doubled(1500),
        runtime=doubled(60),
    params:
        error=lambda wildcards: config["speed"]["error"],
        code=code("speed_growth"),
    message:
        "laboratory: time and memory of the solvers over sizes"
    script:
        "../scripts/speed_growth.py"


rule convergence:
    output:
        f"{RESULTS}/convergence/{{problem}}.nc",
    log:
        f"{RESULTS}/logs/convergence/{{problem}}.log",
    wildcard_constraints:
        problem="hertz|punch|richardson",
    resources:
        mem_mb=doubled(1500),
        runtime=doubled(60),
    params:
        recipe=recipe_of("convergence"),
        code=code("convergence"),
    message:
        "laboratory: error against spacing, {wildcards.problem}"
    script:
        "../scripts/convergence.py"


rule stability_part:
    output:
        f"{RESULTS}/stability_parts/{{first}}.nc",
    log:
        f"{RESULTS}/logs/stability_parts/{{first}}.log",
    wildcard_constraints:
        first=r"\d+",
    resources:
        mem_mb=doubled(1500),
        runtime=doubled(60),
    params:
        kinds=lambda wc: KINDS[int(wc.first) : int(wc.first) + KINDS_A_JOB],
        draws=lambda wildcards: config["stability"]["draws"],
        peers=PEERS,
        code=code("stability_part"),
    message:
        "laboratory: verdicts on solvers, kinds of problem from {wildcards.first}"
    script:
        "../scripts/stability_part.py"


rule stability:
    input:
        parts=expand(rules.stability_part.output, first=range(0, len(KINDS), KINDS_A_JOB)),
    output:
        f"{RESULTS}/stability/scenes.nc",
    log:
        f"{RESULTS}/logs/stability/scenes.log",
    resources:
        mem_mb=doubled(1500),
        runtime=doubled(60),
    params:
        code=code("stability"),
    message:
        "laboratory: verdicts on solvers"
    script:
        "../scripts/stability.py"


rule elimination:
    output:
        f"{RESULTS}/elimination/scenes.nc",
    log:
        f"{RESULTS}/logs/elimination/scenes.log",
    resources:
        mem_mb=doubled(1500),
        runtime=doubled(60),
    params:
        draws=lambda wildcards: config["stability"]["elimination"],
        code=code("elimination"),
    message:
        "laboratory: whether dropping points alone reaches the right contact"
    script:
        "../scripts/elimination.py"


#: Files that the study asks for, in the order of its atlas.
LABORATORY = [
    *(rules.roll_off.output if "roll_off" in config else []),
    *(rules.size_strength.output if "size_strength" in config else []),
    *(rules.area_slope.output if "area_slope" in config else []),
    *(rules.estimator_bias.output if "estimator_bias" in config else []),
    *(rules.size_effect.output if "size_effect" in config else []),
    *expand(rules.speed.output, scene=SCENES),
    *(rules.speed_growth.output if "speed" in config else []),
    *expand(
        rules.convergence.output,
        problem=["hertz", "punch", "richardson"] if "convergence" in config else [],
    ),
    *(rules.stability.output + rules.elimination.output if "stability" in config else []),
]
