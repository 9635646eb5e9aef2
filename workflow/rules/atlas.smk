# Atlases: all results of one specimen in one file, and all of the study in one; in a campaign the study's has one
# row a specimen.

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


def configuration_of(wildcards):
    """Configuration in the atlas of one specimen, without that of the others.

    So a change of another specimen draws no figure of this one again.
    """
    name = known(wildcards)
    stated = {
        key: config[key] for key in ("study", "accuracy", "solver", "figures") if key in config
    }
    if name in config.get("embedded", {}):
        stated["embedded"] = {name: config["embedded"][name]}
    return {"study": stated, "settings": {name: RECORDS[name]}}


# Atlas of one specimen, and its row in a campaign. The job does not need atlas.nc, so a new scan draws only
# its own figures, and a bad scan stops no other specimen's figures. Contact maps are in it, because figures
# show them beside every specimen.
rule specimen_atlas:
    input:
        STAGE_PATTERNS,
        rules.strength.output,
        ENSEMBLE,
        branch(lambda wildcards: wildcards.specimen in TESTED, then=rules.measured.output.measured),
        [] if CAMPAIGN else MAP_FILES,
    output:
        **({"row": SPECIMEN_ROW} if CAMPAIGN else {}),
        atlas=update(SPECIMEN_ATLAS),
    log:
        f"{RESULTS}/logs/specimen_atlas/{{specimen}}.log",
    wildcard_constraints:
        specimen=names_of(SLIDING, FLAT),
    priority: PRIORITY["figures"]
    resources:
        mem_mb=memory("specimen_atlas"),
        runtime=minutes("specimen_atlas"),
    params:
        configuration=configuration_of,
        code=code("specimen_atlas"),
    message:
        "{wildcards.specimen}: its atlas"
    script:
        "../scripts/specimen_atlas.py"


# The same for a specimen that does not slide and has no strength.
use rule specimen_atlas as specimen_atlas_against_plane with:
    input:
        STAGE_PATTERNS,
        rules.size_laws_against_plane.output,
        ENSEMBLE,
        branch(lambda wildcards: wildcards.specimen in TESTED, then=rules.measured.output.measured),
        [] if CAMPAIGN else MAP_FILES,
    log:
        f"{RESULTS}/logs/specimen_atlas_against_plane/{{specimen}}.log",
    wildcard_constraints:
        specimen=names_of(FLAT, SLIDING),
    priority: PRIORITY["figures_against_plane"]


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
