# The atlas of the study: all results in one file; in a campaign, one row a specimen. The rule
# `specimen_atlas`, in the next file, makes that of each specimen.

#: Files that the rules above make of every specimen, whatever its kind, with {specimen} in their names.
STAGE_PATTERNS = [
    *rules.roughness_and_composite.output,
    *rules.windows.output,
    *rules.closure_and_box_counts.output,
    *rules.flow.output,
]
MAP_FILES = expand(rules.contact_map.output, specimen=MAPS)
SPECIMEN_ATLAS = f"{RESULTS}/atlas/{{specimen}}.nc"
# The numbers of a specimen that are compared with others. Its atlas has them too but takes long to open.
SPECIMEN_ROW = f"{RESULTS}/rows/{{specimen}}.nc"

#: Files of all stages of all specimens.
STAGE_FILES = [
    *expand(STAGE_PATTERNS, specimen=SPECIMENS),
    *expand(rules.strength.output, specimen=SLIDING),
    *expand(rules.size_laws_against_plane.output, specimen=FLAT),
    *expand(rules.ensemble.output, specimen=ENSEMBLES),
    *expand(rules.measured.output, specimen=TESTED),
]


# Results of all stages, of contact maps and of experiments (in a campaign, the rows that `specimen_atlas` wrote), and
# the verdicts on the paper's statements about several specimens.
rule atlas:
    input:
        stages=[] if CAMPAIGN else STAGE_FILES,
        rows=expand(SPECIMEN_ROW, specimen=SPECIMENS) if CAMPAIGN else [],
        maps=MAP_FILES,
        laboratory=LABORATORY,
    output:
        # `update`, here and in other rules, keeps the file until the new one is complete. Snakemake would
        # else remove it before the job begins, while somebody may be reading it.
        update(f"{RESULTS}/atlas.nc"),
        # Names of its specimens, one a line. A run that would lose one of them is refused.
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
