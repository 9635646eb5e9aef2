# From scan files, a user's or the study's own, to levelled specimens, their surfaces and joints.


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
    """The faces of a specimen, wherever they come from. Their digests show changes."""
    scan = SCANS.get(wildcards.specimen)
    if scan is None:
        return rules.embedded.output.scan
    return [ancient(str(path)) for path in scan.files]


def reading_of(wildcards):
    """Arguments by which a scan is read, beside its settings.

    Not from the rule's input: Snakemake keeps no record of parameters that follow from it.
    """
    name = known(wildcards)
    scanned = name in SCANS
    files = SCANS[name].files if scanned else expand(rules.embedded.output.scan, specimen=name)
    return {
        "files": list(map(str, files)),
        "options": OPTIONS[name] if scanned else sidecar_of_matrix(recipe_named(name)["spacing"]),
        "name": name,
    }


def memory_of_reading(wildcards):
    """Megabytes that the job of a specimen asks for, by the size of its scan files."""
    name = known(wildcards)
    if name in SCANS:
        return resources.reading_memory(SCANS[name].files)
    return resources.memory("specimen", nodes_of(name)[0])


# The levelled specimen, and its joint before contact is solved: the dimension of its face, what the
# instrument adds and which resolutions go below it, and one face slid over the other (offsets,
# composite topographies, rigid dilatancy). Seconds of work, so one job.
rule specimen:
    input:
        scan_files,
    output:
        **outputs_of("specimens"),
    log:
        f"{RESULTS}/logs/specimen/{{specimen}}.log",
    resources:
        **(asked_for("specimen", grid=0) | {"mem_mb": doubled(memory_of_reading)}),
    params:
        **calling("specimens"),
        arguments=reading_of,
        digests=lambda wc: digests_of(SCANS[wc.specimen]) if wc.specimen in SCANS else {},
    message:
        "{wildcards.specimen}: levelled scan, its surface dimension and its joint"
    script:
        "../scripts/stage.py"


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
