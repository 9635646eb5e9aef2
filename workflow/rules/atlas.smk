# All stages of the study in one file.


def stages_of(wildcards):
    """Files of all stages that an atlas of one specimen has."""
    return STAGE_FILES | MAP_FILES | (SLIDING_FILES if wildcards.specimen in SLIDING else {})


# All stages, and what the paper says compared with them.
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
        mem_mb=doubled(4000),
        runtime=doubled(10),
    params:
        configuration={"study": config, "settings": SETTINGS},
        code=code("atlas"),
    message:
        "the study: its atlas, and what the paper says compared with it"
    script:
        "../scripts/atlas.py"
