# All stages of the study: in one file, or in one a specimen and one of what they have together.
SPECIMEN_ATLAS = f"{RESULTS}/atlas/{{specimen}}.nc"
# What of a specimen is compared with others, beside its atlas, which takes long to open.
SPECIMEN_ROW = f"{RESULTS}/rows/{{specimen}}.nc"


def stages_of(wildcards):
    """Files of all stages that an atlas of one specimen has."""
    return of_specimen(wildcards, *MEMBERS) | ({} if IN_PARTS else MAP_FILES)


def files_of_all():
    """Files of the stages of all specimens, by stage; those of an optional grain where it has any."""
    return {
        stage: expand(path, specimen=names)
        for grain, names in MEMBERS.items()
        if names or grain in (SPECIMEN, JOINT)
        for stage, path in files_of(stages.paths_of(grain)).items()
    }


# All stages, and what the paper says compared with them.
rule atlas:
    input:
        **({"rows": expand(SPECIMEN_ROW, specimen=SPECIMENS)} if IN_PARTS else files_of_all()),
        **MAP_FILES,
        **STUDY_FILES,
    output:
        # `update` here and below: Snakemake would remove what readers have before its job begins.
        update(f"{RESULTS}/atlas.nc"),
        # Which specimens it has, one a line: kept from being lost without a word.
        names=update(f"{RESULTS}/specimens.txt"),
    log:
        f"{RESULTS}/logs/atlas.log",
    resources:
        **fixed(4000, 10),
    params:
        configuration={"study": config, "settings": RECORDS},
        code=code("atlas"),
    message:
        "the study: its atlas, and what the paper says compared with it"
    script:
        "../scripts/atlas.py"
