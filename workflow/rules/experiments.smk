# Experiments on synthetic surfaces, each once where the study has its key.


# What a roll-off of the spectrum does to the rigid dilatancy.
rule roll_off:
    output:
        **outputs_of("roll_off"),
    log:
        f"{RESULTS}/logs/roll_off.log",
    benchmark:
        f"{RESULTS}/benchmarks/roll_off.tsv"
    priority: 1
    resources:
        mem_mb=doubled(2000),
        runtime=doubled(30),
    params:
        **(resolve_roll_off(config, SOURCE) or {}),
        **calling("roll_off"),
    message:
        "roll-off: dilatancy of synthetic joints with and without one"
    script:
        "../scripts/stage.py"


# How the real contact area begins to grow, with and without a roll-off.
rule area_slope:
    output:
        **outputs_of("area_slope"),
    log:
        f"{RESULTS}/logs/area_slope.log",
    benchmark:
        f"{RESULTS}/benchmarks/area_slope.tsv"
    # Short, and nothing waits for it but the end: it fills the core that has nothing else to do.
    priority: -1
    resources:
        mem_mb=doubled(2000),
        runtime=doubled(60),
    params:
        **calling("area_slope"),
        recipe=config.get("area_slope"),
        rtol=SOLVER.rtol,
    message:
        "area slope: contact area at light load, compared with the theories"
    script:
        "../scripts/stage.py"


# Whether the two estimates of Delta_sigma agree in any limit.
rule dimension_test:
    output:
        **outputs_of("dimension_test"),
    log:
        f"{RESULTS}/logs/dimension_test.log",
    benchmark:
        f"{RESULTS}/benchmarks/dimension_test.tsv"
    # Long, and nothing waits for it: begun last it would keep one core busy and the others idle.
    priority: 1
    resources:
        mem_mb=doubled(4000),
        # A partition may allow no more than an hour; who needs more gets it at the second attempt.
        runtime=doubled(60),
    params:
        **calling("dimension_test"),
        recipe=config.get("dimension_test"),
        rtol=SOLVER.rtol,
    message:
        "dimension test: both estimates of Delta_sigma on synthetic surfaces"
    script:
        "../scripts/stage.py"


# How far the estimators of Delta_g are off.
rule estimator_bias:
    output:
        **outputs_of("estimator_bias"),
    log:
        f"{RESULTS}/logs/estimator_bias.log",
    benchmark:
        f"{RESULTS}/benchmarks/estimator_bias.tsv"
    # As area_slope.
    priority: -1
    resources:
        mem_mb=doubled(2000),
        runtime=doubled(60),
    params:
        **calling("estimator_bias"),
        recipe=config.get("estimator_bias"),
    message:
        "estimator bias: Delta_g of synthetic surfaces of known dimension"
    script:
        "../scripts/stage.py"


# Whether the strength of sliding joints has a size effect.
rule size_strength:
    output:
        **outputs_of("size_strength"),
    log:
        f"{RESULTS}/logs/size_strength.log",
    benchmark:
        f"{RESULTS}/benchmarks/size_strength.tsv"
    # Long, and nothing waits for it: begun last it would keep one core busy and the others idle.
    priority: 1
    resources:
        mem_mb=doubled(4000),
        runtime=doubled(120),
    params:
        **calling("size_strength"),
        recipe=config.get("size_strength"),
        rtol=SOLVER.rtol,
    message:
        "size strength: synthetic joints that slide, over their size"
    script:
        "../scripts/stage.py"
