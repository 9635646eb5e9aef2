# From scan files, a user's or the study's own, to levelled specimens, their surfaces and joints.


rule embedded:
    output:
        scan=f"{RESULTS}/embedded/{{specimen}}.npy",
        sidecar=f"{RESULTS}/embedded/{{specimen}}.yaml",
    log:
        f"{RESULTS}/logs/embedded/{{specimen}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/embedded/{{specimen}}.tsv"
    conda:
        "../../environment.yml"
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        recipe=lambda wc: resolve_embedded(config["embedded"][wc.specimen], "embedded"),
        code=code("synthesis"),
    script:
        "../scripts/embedded.py"


def scan_files(wildcards):
    """The faces of a specimen and its sidecar, wherever they come from."""
    name = wildcards.specimen
    if name not in SCANS:
        return {"lower": rules.embedded.output.scan, "sidecar": rules.embedded.output.sidecar}
    scan = SCANS[name]
    files = {"lower": scan.lower, "upper": scan.upper, "sidecar": scan.sidecar}
    return {role: str(path) for role, path in files.items() if path is not None}


# The levelled specimen, and what is known of its joint before anything is pressed: the dimension of
# its face, what the instrument adds and which resolutions go below it, and one face slid over the
# other (offsets, composite topographies, rigid dilatancy). Seconds of work, so one job.
rule specimen:
    input:
        unpack(scan_files),
        schema=SCHEMA_FILE,
    output:
        specimen=f"{RESULTS}/specimens/{{specimen}}.nc",
        surface_dimension=f"{RESULTS}/surface_dimension/{{specimen}}.nc",
        quality=f"{RESULTS}/quality/{{specimen}}.nc",
        joint=f"{RESULTS}/joints/{{specimen}}.nc",
    log:
        f"{RESULTS}/logs/specimen/{{specimen}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/specimen/{{specimen}}.tsv"
    conda:
        "../../environment.yml"
    resources:
        mem_mb=lambda wc, attempt: 2000 * attempt,
        runtime=15,
    params:
        settings=settings_of,
        code=code("joint", "preparation", "quality", "roughness", "store"),
    script:
        "../scripts/specimen.py"
