# All that was computed, in one file; or of many specimens in one a specimen, and one of what they
# have together.

#: Files that the rules above make of every specimen, whatever its kind, with {specimen} in their names.
STAGE_PATTERNS = [
    *rules.roughness_and_composite.output,
    *rules.windows.output,
    *rules.closure_and_box_counts.output,
    *rules.flow.output,
]
MAP_FILES = expand(rules.contact_map.output, specimen=MAPS)
SPECIMEN_ATLAS = f"{RESULTS}/atlas/{{specimen}}.nc"
# What of a specimen is compared with others, beside its atlas, which takes long to open.
SPECIMEN_ROW = f"{RESULTS}/rows/{{specimen}}.nc"

#: Files of all stages of all specimens.
STAGE_FILES = [
    *expand(STAGE_PATTERNS, specimen=SPECIMENS),
    *expand(list(rules.strength.output), specimen=SLIDING),
    *expand(list(rules.size_laws_against_plane.output), specimen=FLAT),
    *expand(list(rules.ensemble.output), specimen=ENSEMBLES),
    *expand(list(rules.measured.output), specimen=TESTED),
]


# All that the rules above made, with the verdicts on what the paper says of several specimens.
rule atlas:
    input:
        stages=[] if IN_PARTS else STAGE_FILES,
        rows=expand(SPECIMEN_ROW, specimen=SPECIMENS) if IN_PARTS else [],
        maps=MAP_FILES,
        laboratory=LABORATORY,
    output:
        # `update` here and below: Snakemake would remove what readers have before its job begins.
        update(f"{RESULTS}/atlas.nc"),
        # Which specimens it has, one a line: kept from being lost without a word.
        names=update(f"{RESULTS}/specimens.txt"),
    log:
        f"{RESULTS}/logs/atlas.log",
    resources:
        mem_mb=doubled(4000),
        runtime=doubled(10),
    params:
        configuration={"study": config, "settings": RECORDS},
        code=code("atlas"),
    message:
        "the study: its atlas, and what the paper says compared with it"
    script:
        "../scripts/atlas.py"
