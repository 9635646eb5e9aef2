# Scan files of users, or synthetic ones of the study; the levelled faces, their roughness, and the
# composite topographies of one face slid over the other (section 4 of the paper).
from fractalcontact.study.sidecar import sidecar_of_matrix


rule synthetic_scan:
    output:
        scan=f"{RESULTS}/embedded/{{specimen}}.npy",
        sidecar=f"{RESULTS}/embedded/{{specimen}}.yaml",
    log:
        f"{RESULTS}/logs/synthetic_scan/{{specimen}}.log",
    resources:
        mem_mb=memory("synthetic_scan", face_nodes),
        runtime=minutes("synthetic_scan", face_nodes),
    params:
        recipe=lambda wildcards: recipe_named(known(wildcards)),
        code=code("synthetic_scan"),
    message:
        "{wildcards.specimen}: synthetic scan"
    script:
        "../scripts/synthetic_scan.py"


def scan_files(wildcards):
    """Scan files of a specimen or of a measured map.

    `ancient` ignores their dates: a changed content changes `digests`, which makes the job run again.
    """
    if wildcards.specimen not in SCANS:
        return rules.synthetic_scan.output.scan
    return [ancient(str(path)) for path in SCANS[wildcards.specimen].files]


def scan_digests(wildcards):
    """SHA-256 of these files; none for a surface that the study makes itself."""
    return PLAN.digests(*SCANS[wildcards.specimen].files) if wildcards.specimen in SCANS else {}


def reading_options(wildcards):
    """Scan keys of the sidecar of a specimen."""
    name = known(wildcards)
    return OPTIONS[name] if name in SCANS else sidecar_of_matrix(recipe_named(name)["spacing"])


def memory_of_reading(wildcards):
    """Requested megabytes of the job of a specimen, by the size of its scan files."""
    name = known(wildcards)
    if name in SCANS:
        return estimates.reading_memory(SCANS[name].files)
    return estimates.memory("roughness_and_composite", face_nodes(name))


# One job, because reading the scan takes most of its seconds.
rule roughness_and_composite:
    input:
        scan_files,
    output:
        specimens=f"{RESULTS}/specimens/{{specimen}}.nc",
        quality=f"{RESULTS}/quality/{{specimen}}.nc",
        surface_dimension=f"{RESULTS}/surface_dimension/{{specimen}}.nc",
        joints=f"{RESULTS}/joints/{{specimen}}.nc",
    log:
        f"{RESULTS}/logs/roughness_and_composite/{{specimen}}.log",
    resources:
        mem_mb=doubled(memory_of_reading),
        runtime=minutes("roughness_and_composite", face_nodes),
    params:
        settings=settings_of(settings.SpecimenSettings),
        options=reading_options,
        digests=scan_digests,
        code=code("roughness_and_composite"),
    message:
        "{wildcards.specimen}: levelled faces, Delta_g, composite topographies at all offsets"
    script:
        "../scripts/roughness_and_composite.py"


# Measured map of contact and its dimension. Nothing is solved; {specimen} is the name of the map.
rule contact_map:
    input:
        scan_files,
    output:
        f"{RESULTS}/contact_maps/{{specimen}}.nc",
    log:
        f"{RESULTS}/logs/contact_map/{{specimen}}.log",
    wildcard_constraints:
        specimen=alternation(MAPS),
    resources:
        mem_mb=doubled(2000),
        runtime=doubled(10),
    params:
        options=lambda wildcards: OPTIONS[wildcards.specimen],
        label=lambda wildcards: LABELS[wildcards.specimen],
        digests=scan_digests,
        code=code("contact_map"),
    message:
        "{wildcards.specimen}: measured contact map and its dimension"
    script:
        "../scripts/contact_map.py"


#: Errors of the scans that are left out.
REFUSED = [str(STUDY.refused[name]) for name in sorted(STUDY.refused)]


# One job for each scan that is left out with --keep-going. It fails with what is wrong with the scan, and its
# output is never made; other jobs go on.
rule refused:
    output:
        f"{RESULTS}/refused/{{refused}}.txt",
    log:
        f"{RESULTS}/logs/refused/{{refused}}.log",
    params:
        reason=lambda wildcards: REFUSED[int(wildcards.refused)],
    message:
        "a scan that is left out: what is wrong with it"
    script:
        "../scripts/refused.py"
