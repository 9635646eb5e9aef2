# Experiments on made surfaces. Then the atlas.


# Whether the two estimates of Delta_sigma agree in any limit, and how far the estimators of Delta_g
# are off.
rule dimension_test:
    output:
        f"{RESULTS}/dimension_test/surfaces.nc",
    log:
        f"{RESULTS}/logs/dimension_test.log",
    benchmark:
        f"{RESULTS}/benchmarks/dimension_test.tsv"
    # Long, and nothing waits for it: begun last it would keep one core busy and the others idle.
    priority: 1
    conda:
        "../../environment.yml"
    resources:
        mem_mb=lambda wc, attempt: 4000 * attempt,
        # A partition may allow no more than an hour; who needs more gets it at the second attempt.
        runtime=lambda wc, attempt: 60 * attempt,
    params:
        recipe=config.get("dimension_test"),
        rtol=SOLVER["rtol"],
        code=code("dimension_test"),
    script:
        "../scripts/dimension_test.py"


rule estimator_bias:
    output:
        f"{RESULTS}/estimator_bias/surfaces.nc",
    log:
        f"{RESULTS}/logs/estimator_bias.log",
    benchmark:
        f"{RESULTS}/benchmarks/estimator_bias.tsv"
    # As area_slope.
    priority: -1
    conda:
        "../../environment.yml"
    resources:
        mem_mb=2000,
        runtime=60,
    params:
        recipe=config.get("estimator_bias"),
        code=code("estimator_bias"),
    script:
        "../scripts/estimator_bias.py"


STAGE_FILES = {
    "specimens": rules.specimen.output.specimen,
    "quality": rules.specimen.output.quality,
    "surface_dimension": rules.specimen.output.surface_dimension,
    "joints": rules.specimen.output.joint,
    "windows": rules.windows.output.windows,
    "size_test": rules.windows.output.size_test,
    **ANALYSIS_FILES,
}
# What only joints that slide have.
SLIDING_FILES = {"strength": STRENGTH_FILE}
# Measured contact maps stand in every atlas, beside the domains computed there.
MAP_FILES = {"contact_maps": expand(rules.contact_map.output, map=MAPS)} if MAPS else {}
# What the study has once.
STUDY_FILES = {stage: getattr(rules, stage).output[0] for stage in EXPERIMENTS if stage in config}


def stages_of(wildcards):
    return STAGE_FILES | MAP_FILES | (SLIDING_FILES if wildcards.specimen in SLIDING else {})


# All of this, with what the paper says held against it.
rule atlas:
    input:
        **{stage: expand(path, specimen=SPECIMENS) for stage, path in STAGE_FILES.items()},
        **{stage: expand(path, specimen=SLIDING) for stage, path in SLIDING_FILES.items()},
        **MAP_FILES,
        **STUDY_FILES,
    output:
        f"{RESULTS}/atlas.nc",
        # Which specimens it has, one a line: kept from being lost without a word.
        names=f"{RESULTS}/specimens.txt",
    log:
        f"{RESULTS}/logs/atlas.log",
    benchmark:
        f"{RESULTS}/benchmarks/atlas.tsv"
    conda:
        "../../environment.yml"
    resources:
        mem_mb=4000,
        runtime=10,
    params:
        configuration={"study": config, "settings": SETTINGS},
        code=code("atlas"),
    script:
        "../scripts/atlas.py"
