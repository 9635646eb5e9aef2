# All stages of the study: in one file, or in one a specimen and one of what they have together.
SPECIMEN_ATLAS = f"{RESULTS}/atlas/{{specimen}}.nc"
# What of a specimen is compared with others, beside its atlas, which takes long to open.
SPECIMEN_ROW = f"{RESULTS}/rows/{{specimen}}.nc"


def stages_of(wildcards):
    """Files of all stages that an atlas of one specimen has."""
    maps = {} if IN_PARTS else MAP_FILES
    sliding = SLIDING_FILES if wildcards.specimen in SLIDING_NAMES else {}
    tests = TESTED_FILES if wildcards.specimen in TESTED_NAMES else {}
    return STAGE_FILES | maps | sliding | tests | ensemble_of(wildcards)


def atlas_inputs():
    """What the atlas of the study is made of: all stages, or a row of each specimen."""
    if IN_PARTS:
        return {"rows": expand(SPECIMEN_ROW, specimen=SPECIMENS)}
    specimens = {stage: expand(path, specimen=SPECIMENS) for stage, path in STAGE_FILES.items()}
    sliding = {stage: expand(path, specimen=SLIDING) for stage, path in SLIDING_FILES.items()}
    ensembles = {
        stage: expand(path, specimen=REALISATIONS) for stage, path in ENSEMBLE_FILES.items()
    }
    tests = {stage: expand(path, specimen=TESTED_NAMES) for stage, path in TESTED_FILES.items()}
    optional = (ensembles if REALISATIONS else {}) | (tests if TESTED_NAMES else {})
    return specimens | sliding | optional


# All stages, and what the paper says compared with them.
rule atlas:
    input:
        **atlas_inputs(),
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
    resources:
        **fixed(4000, 10),
    params:
        configuration={"study": config, "settings": RECORDS},
        code=code("atlas"),
    message:
        "the study: its atlas, and what the paper says compared with it"
    script:
        "../scripts/atlas.py"
