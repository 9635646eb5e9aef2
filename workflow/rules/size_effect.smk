# The decisive experiment: surfaces of one class a job, minutes each, in any order; small classes
# share a job.
SIZE_JOBS = size_jobs(config["size_effect"]) if "size_effect" in config else {}


rule size_effect_part:
    output:
        f"{RESULTS}/size_effect_parts/{{job}}.nc",
    log:
        f"{RESULTS}/logs/size_effect_parts/{{job}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/size_effect_parts/{{job}}.tsv"
    wildcard_constraints:
        job=alternation(SIZE_JOBS),
    # The longest first: begun last it would keep one core busy and the others idle.
    priority: 1
    resources:
        # By the largest surface of the job.
        mem_mb=lambda wc, attempt: resources.memory(
            "size_effect_part",
            max(task.whole or task.size for task in SIZE_JOBS[wc.job]) ** 2,
            attempt=attempt,
        ),
        runtime=doubled(60),
    params:
        function="contactlab.experiments.size_states:solve_tasks",
        tasks=lambda wc: [list(task) for task in SIZE_JOBS[wc.job]],
        loads=config.get("size_effect", {}).get("loads"),
        rtol=SOLVER.rtol,
        code=code("stage", "contactlab/experiments/size_states.py"),
    message:
        "size effect: synthetic surfaces {wildcards.job}"
    script:
        "../scripts/stage.py"


rule size_effect:
    input:
        parts=expand(rules.size_effect_part.output[0], job=SIZE_JOBS),
    output:
        **outputs_of("size_effect"),
    log:
        f"{RESULTS}/logs/size_effect.log",
    benchmark:
        f"{RESULTS}/benchmarks/size_effect.tsv"
    resources:
        **fixed(2000, 20),
    params:
        **calling("size_effect"),
        recipe=config.get("size_effect"),
    message:
        "size effect: exponents, and what carries them"
    script:
        "../scripts/stage.py"
