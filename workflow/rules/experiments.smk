# Experiments on synthetic surfaces, each once where the study has its key; that on the size effect,
# which takes many jobs, is in size_effect.smk.

#: Long, and nothing waits for them: begun last they would keep one core busy and the others idle.
#: Minutes that each asks for: a partition may allow no more than an hour, and what needs more gets
#: it at the second attempt.
LONG = {"roll_off": 30, "dimension_test": 60, "size_strength": 120}
#: Short: they fill the core that has nothing else to do at the end.
SHORT = ("area_slope", "estimator_bias")


def experiment(wildcards):
    """Arguments of an experiment: its recipe, and how exactly it is to solve."""
    name = wildcards.experiment
    if name == "roll_off":
        return resolve_roll_off(config, SOURCE)
    given = {"recipe": config[name]}
    return given if name == "estimator_bias" else given | {"rtol": SOLVER.rtol}


rule long_experiment:
    output:
        f"{RESULTS}/{{experiment}}/surfaces.nc",
    log:
        f"{RESULTS}/logs/{{experiment}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/{{experiment}}.tsv"
    wildcard_constraints:
        experiment=alternation([name for name in LONG if name in config]),
    priority: 1
    resources:
        mem_mb=doubled(4000),
        runtime=lambda wc, attempt: LONG.get(wc.experiment, 60) * 2 ** (attempt - 1),
    params:
        function=lambda wc: stages.STAGES[wc.experiment].function,
        arguments=experiment,
        code=lambda wc: calling(wc.experiment)["code"](wc),
    message:
        "{wildcards.experiment}: experiment on synthetic surfaces"
    script:
        "../scripts/stage.py"


use rule long_experiment as short_experiment with:
    wildcard_constraints:
        experiment=alternation([name for name in SHORT if name in config]),
    priority: -1
