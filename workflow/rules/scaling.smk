# Contact domains: box counts, clusters, and what changes with resolution. Then the atlas.


rule domains:
    input:
        specimen=rules.specimen.output[0],
        contact=contact_parts,
    output:
        domains=f"{RESULTS}/domains/{{specimen}}.nc",
        contact=f"{RESULTS}/contact/{{specimen}}.nc",
    log:
        f"{RESULTS}/logs/domains/{{specimen}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/domains/{{specimen}}.tsv"
    conda:
        "../../environment.yml"
    resources:
        mem_mb=2000,
        runtime=20,
    params:
        settings=settings_of,
        code=code("analysis", "sweep", "store"),
    script:
        "../scripts/domains.py"


rule scaling:
    input:
        specimen=rules.specimen.output[0],
        closure=rules.closure.output.closure,
        domains=rules.domains.output.domains,
    output:
        f"{RESULTS}/scaling/{{specimen}}.nc",
    log:
        f"{RESULTS}/logs/scaling/{{specimen}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/scaling/{{specimen}}.tsv"
    conda:
        "../../environment.yml"
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        settings=settings_of,
        code=code("analysis", "sweep", "store"),
    script:
        "../scripts/scaling.py"


STAGE_FILES = {
    "specimens": rules.specimen.output[0],
    "surface_dimension": rules.surface_dimension.output[0],
    "joints": rules.joint.output[0],
    "contact": rules.domains.output.contact,
    "closure": rules.closure.output.closure,
    "dilatancy": rules.closure.output.dilatancy,
    "domains": rules.domains.output.domains,
    "scaling": rules.scaling.output[0],
}


# An atlas of one specimen: its figures need no other, so a new scan redraws only its own, and one
# bad scan does not keep the others from theirs.
rule specimen_atlas:
    input:
        **STAGE_FILES,
    output:
        f"{RESULTS}/atlas/{{specimen}}.nc",
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
        specimens=lambda wc: [wc.specimen],
        configuration=lambda wc: {"study": config, "settings": {wc.specimen: settings_of(wc)}},
        code=code("store"),
    script:
        "../scripts/atlas.py"


rule atlas:
    input:
        **{stage: expand(path, specimen=SPECIMENS) for stage, path in STAGE_FILES.items()},
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
        specimens=SPECIMENS,
        configuration={"study": config, "settings": SETTINGS},
        code=code("store"),
    script:
        "../scripts/atlas.py"
