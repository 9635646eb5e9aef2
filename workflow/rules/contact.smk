# Contact solves, the costly part. One job takes one specimen and direction, and as many offsets and
# resolutions as the study's `grain` says, with all their loads.


def parts_of(specimen):
    """Slices of offsets and of resolutions that the jobs of a specimen take."""
    settings = SETTINGS[specimen]
    # How many offsets "auto" finds is known only later; a job without any writes an empty part.
    n_offsets = len(settings["offsets"]) if settings["offsets"] else AUTOMATIC_OFFSETS + 1
    return grain("offsets", n_offsets), grain("resolutions", len(settings["resolutions"]))


rule contact:
    input:
        specimen=rules.specimen.output[0],
        joint=rules.joint.output[0],
    output:
        f"{RESULTS}/contact/{{specimen}}/{{direction}}.{{part}}.{{level}}.nc",
    log:
        f"{RESULTS}/logs/contact/{{specimen}}/{{direction}}.{{part}}.{{level}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/contact/{{specimen}}/{{direction}}.{{part}}.{{level}}.tsv"
    conda:
        "../../environment.yml"
    resources:
        mem_mb=lambda wc, attempt: 2000 * attempt,
        runtime=60,
    params:
        settings=settings_of,
        solver=SOLVER,
        offsets=lambda wc: parts_of(wc.specimen)[0][int(wc.part)],
        resolutions=lambda wc: SETTINGS[wc.specimen]["resolutions"][
            slice(*parts_of(wc.specimen)[1][int(wc.level)])
        ],
        code=code("sweep", "store"),
    script:
        "../scripts/contact.py"


def contact_parts(wildcards):
    offsets, resolutions = parts_of(wildcards.specimen)
    return expand(
        rules.contact.output,
        specimen=wildcards.specimen,
        direction=SETTINGS[wildcards.specimen]["contact_directions"],
        part=range(len(offsets)),
        level=range(len(resolutions)),
    )


# Closure curves and what follows from them alone: seconds of work, so one job.
rule closure:
    input:
        specimen=rules.specimen.output[0],
        surface_dimension=rules.surface_dimension.output[0],
        joint=rules.joint.output[0],
        contact=contact_parts,
    output:
        closure=f"{RESULTS}/closure/{{specimen}}.nc",
        dilatancy=f"{RESULTS}/dilatancy/{{specimen}}.nc",
        choices=f"{RESULTS}/choices/{{specimen}}.nc",
        area=f"{RESULTS}/area/{{specimen}}.nc",
    log:
        f"{RESULTS}/logs/closure/{{specimen}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/closure/{{specimen}}.tsv"
    conda:
        "../../environment.yml"
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        settings=settings_of,
        solver=SOLVER,
        code=code("area", "closure", "needs", "roughness", "states", "store"),
    script:
        "../scripts/closure.py"


# A measured map of contact goes straight to the analysis of domains.
rule contact_map:
    input:
        scan=lambda wc: str(MAPS[wc.map].lower),
        sidecar=lambda wc: str(MAPS[wc.map].sidecar),
        schema=SCHEMA_FILE,
    output:
        f"{RESULTS}/contact_maps/{{map}}.nc",
    log:
        f"{RESULTS}/logs/contact_map/{{map}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/contact_map/{{map}}.tsv"
    conda:
        "../../environment.yml"
    resources:
        mem_mb=2000,
        runtime=10,
    params:
        code=code("contact_map", "study", "store"),
    script:
        "../scripts/contact_map.py"


# Box counts, dimension and clusters of every contact domain, and what changes with resolution.
rule domains:
    input:
        specimen=rules.specimen.output[0],
        contact=contact_parts,
        closure=rules.closure.output.closure,
    output:
        domains=f"{RESULTS}/domains/{{specimen}}.nc",
        contact=f"{RESULTS}/contact/{{specimen}}.nc",
        scaling=f"{RESULTS}/scaling/{{specimen}}.nc",
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
        code=code("analysis", "states", "store"),
    script:
        "../scripts/domains.py"
