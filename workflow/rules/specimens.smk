# Scan files, a user's or the study's own, and how they are read.


rule embedded:
    output:
        scan=f"{RESULTS}/embedded/{{specimen}}.npy",
        sidecar=f"{RESULTS}/embedded/{{specimen}}.yaml",
    log:
        f"{RESULTS}/logs/embedded/{{specimen}}.log",
    resources:
        **asked_for("embedded", grid=0),
    params:
        recipe=lambda wc: recipe_named(known(wc)),
        code=code("embedded"),
    message:
        "{wildcards.specimen}: synthetic scan"
    script:
        "../scripts/embedded.py"


def scan_files(wildcards):
    """The faces of a specimen, or a measured map, wherever they come from. Digests show changes."""
    scan = SCANS.get(wildcards.specimen)
    if scan is None:
        return [rules.embedded.output.scan]
    return [ancient(str(path)) for path in scan.files]


def scan_digests_of(wildcards):
    """Digests of these, but of what the study makes itself."""
    return digests_of(*SCANS[wildcards.specimen].files) if wildcards.specimen in SCANS else {}


def reading_of(wildcards):
    """Arguments by which a scan is read, beside its settings.

    Not from the rule's input: Snakemake keeps no record of parameters that follow from it.
    """
    name = known(wildcards)
    if name in SCANS:
        return {"files": list(map(str, SCANS[name].files)), "options": OPTIONS[name], "name": name}
    files, spacing = (
        expand(rules.embedded.output.scan, specimen=name),
        recipe_named(name)["spacing"],
    )
    return {"files": files, "options": sidecar_of_matrix(spacing), "name": name}


def memory_of_reading(wildcards):
    """Megabytes that the job of a specimen asks for, by the size of its scan files."""
    name = known(wildcards)
    if name in SCANS:
        return resources.reading_memory(SCANS[name].files)
    return resources.memory("specimen", nodes_of(name)[0])


# A scan that the study leaves out, with --keep-going: its job fails and says why, others go on.
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
