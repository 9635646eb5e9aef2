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
        code=code("dimension_test", "store"),
    script:
        "../scripts/dimension_test.py"


rule estimator_bias:
    output:
        f"{RESULTS}/estimator_bias/surfaces.nc",
    log:
        f"{RESULTS}/logs/estimator_bias.log",
    benchmark:
        f"{RESULTS}/benchmarks/estimator_bias.tsv"
    conda:
        "../../environment.yml"
    resources:
        mem_mb=2000,
        runtime=60,
    params:
        recipe=config.get("estimator_bias"),
        code=code("estimator_bias", "store"),
    script:
        "../scripts/estimator_bias.py"


STAGE_FILES = {
    "specimens": rules.specimen.output[0],
    "quality": rules.surfaces.output.quality,
    "surface_dimension": rules.surfaces.output.surface_dimension,
    "joints": rules.surfaces.output.joint,
    "contact": rules.analysis.output.contact,
    "closure": rules.analysis.output.closure,
    "dilatancy": rules.analysis.output.dilatancy,
    "choices": rules.analysis.output.choices,
    "area": rules.analysis.output.area,
    "windows": rules.windows.output.windows,
    "domains": rules.analysis.output.domains,
    "domain_measures": rules.analysis.output.domain_measures,
    "scaling": rules.analysis.output.scaling,
    "size_test": rules.windows.output.size_test,
}
# What only joints that slide have.
SLIDING_FILES = {"strength": rules.strength.output[0]}
# Measured contact maps stand in every atlas, beside the domains computed there.
MAP_FILES = {"contact_maps": expand(rules.contact_map.output, map=MAPS)} if MAPS else {}
# What the study has once.
STUDY_FILES = {stage: getattr(rules, stage).output[0] for stage in EXPERIMENTS if stage in config}


def stages_of(wildcards):
    return STAGE_FILES | MAP_FILES | (SLIDING_FILES if wildcards.specimen in SLIDING else {})


# What the paper says, held against all of this, and the atlas of one specimen: its figures need no
# other, so a new scan redraws only its own, and one bad scan does not keep the others from theirs.
rule specimen_atlas:
    input:
        unpack(stages_of),
    output:
        atlas=f"{RESULTS}/atlas/{{specimen}}.nc",
        statements=f"{RESULTS}/statements/{{specimen}}.nc",
    log:
        f"{RESULTS}/logs/atlas/{{specimen}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/atlas/{{specimen}}.tsv"
    conda:
        "../../environment.yml"
    resources:
        mem_mb=2000,
        runtime=10,
    params:
        configuration=lambda wc: {"study": config, "settings": {wc.specimen: settings_of(wc)}},
        code=code("statements", "store"),
    script:
        "../scripts/specimen_atlas.py"


rule atlas:
    input:
        **{stage: expand(path, specimen=SPECIMENS) for stage, path in STAGE_FILES.items()},
        **{stage: expand(path, specimen=SLIDING) for stage, path in SLIDING_FILES.items()},
        **MAP_FILES,
        **STUDY_FILES,
        statements=expand(rules.specimen_atlas.output.statements, specimen=SPECIMENS),
    output:
        f"{RESULTS}/atlas.nc",
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
        code=code("store"),
    script:
        "../scripts/atlas.py"
