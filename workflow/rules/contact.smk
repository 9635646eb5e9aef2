# Contact solves, the costly part. One job takes one specimen, and as many directions, offsets and
# resolutions as the study's `grain` says, with all their loads.


def parts_of(specimen):
    """Slices of directions, of offsets and of resolutions that the jobs of a specimen take."""
    settings = SETTINGS[specimen]
    # How many offsets "auto" finds is known only later; a job without any writes an empty part.
    n_offsets = len(settings["offsets"]) if settings["offsets"] else AUTOMATIC_OFFSETS + 1
    return {
        "directions": grain("directions", len(settings["contact_directions"])),
        "offsets": grain("offsets", n_offsets),
        "resolutions": grain("resolutions", len(settings["resolutions"])),
    }


def part_of(wildcards, key):
    """Start and stop of the directions, offsets or resolutions that a contact job takes."""
    return parts_of(wildcards.specimen)[key][int(wildcards[key])]


rule contact:
    input:
        specimen=rules.specimen.output[0],
        joint=rules.surfaces.output.joint,
    output:
        f"{RESULTS}/contact/{{specimen}}/{{directions}}.{{offsets}}.{{resolutions}}.nc",
    log:
        f"{RESULTS}/logs/contact/{{specimen}}/{{directions}}.{{offsets}}.{{resolutions}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/contact/{{specimen}}/{{directions}}.{{offsets}}.{{resolutions}}.tsv"
    conda:
        "../../environment.yml"
    resources:
        mem_mb=lambda wc, attempt: 2000 * attempt,
        runtime=60,
    params:
        settings=settings_of,
        solver=SOLVER,
        directions=lambda wc: settings_of(wc)["contact_directions"][
            slice(*part_of(wc, "directions"))
        ],
        offsets=lambda wc: part_of(wc, "offsets"),
        resolutions=lambda wc: settings_of(wc)["resolutions"][slice(*part_of(wc, "resolutions"))],
        code=code("sweep", "store"),
    script:
        "../scripts/contact.py"


def contact_parts(wildcards):
    counts = {key: range(len(slices)) for key, slices in parts_of(wildcards.specimen).items()}
    return expand(rules.contact.output, specimen=wildcards.specimen, **counts)


# What is made of the states of a specimen: closure curves and what follows from them; box counts,
# dimension and clusters of every contact domain, what changes with resolution, lacunarity and
# generalised dimensions of the domains that are drawn. Seconds of work, so one job.
rule analysis:
    input:
        specimen=rules.specimen.output[0],
        surface_dimension=rules.surfaces.output.surface_dimension,
        joint=rules.surfaces.output.joint,
        contact=contact_parts,
    output:
        closure=f"{RESULTS}/closure/{{specimen}}.nc",
        dilatancy=f"{RESULTS}/dilatancy/{{specimen}}.nc",
        choices=f"{RESULTS}/choices/{{specimen}}.nc",
        area=f"{RESULTS}/area/{{specimen}}.nc",
        domains=f"{RESULTS}/domains/{{specimen}}.nc",
        contact=f"{RESULTS}/contact/{{specimen}}.nc",
        scaling=f"{RESULTS}/scaling/{{specimen}}.nc",
        domain_measures=f"{RESULTS}/domain_measures/{{specimen}}.nc",
    log:
        f"{RESULTS}/logs/analysis/{{specimen}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/analysis/{{specimen}}.tsv"
    conda:
        "../../environment.yml"
    resources:
        mem_mb=2000,
        runtime=20,
    params:
        settings=settings_of,
        solver=SOLVER,
        code=code(
            "analysis",
            "area",
            "closure",
            "domain_measures",
            "needs",
            "roughness",
            "states",
            "store",
        ),
    script:
        "../scripts/analysis.py"


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
