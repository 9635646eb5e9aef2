# Contact solves, the costly part. One job takes one specimen, and as many directions, offsets and
# resolutions as the study's `grain` says, with all their loads.


def parts_of(specimen):
    """Slices of directions, of offsets and of resolutions that the jobs of a specimen take."""
    settings = SETTINGS[specimen]
    return {
        "directions": grain("directions", len(settings.contact_directions)),
        # Where there are fewer offsets, a job without any writes an empty part.
        "offsets": grain("offsets", most_offsets(specimen)),
        "resolutions": grain("resolutions", len(settings.resolutions)),
    }


def part_of(wildcards, key):
    """Start and stop of the directions, offsets or resolutions that a contact job takes."""
    return parts_of(wildcards.specimen)[key][int(wildcards[key])]


rule contact:
    input:
        specimens=rules.specimen.output.specimens,
        joints=rules.specimen.output.joints,
    output:
        f"{RESULTS}/contact/{{specimen}}/{{directions}}.{{offsets}}.{{resolutions}}.nc",
    log:
        f"{RESULTS}/logs/contact/{{specimen}}/{{directions}}.{{offsets}}.{{resolutions}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/contact/{{specimen}}/{{directions}}.{{offsets}}.{{resolutions}}.tsv"
    resources:
        **asked_for("contact"),
    params:
        settings=settings_read_by(stages.CONTACT),
        directions=lambda wc: SETTINGS[wc.specimen].contact_directions[
            slice(*part_of(wc, "directions"))
        ],
        offsets=lambda wc: part_of(wc, "offsets"),
        resolutions=lambda wc: SETTINGS[wc.specimen].resolutions[slice(*part_of(wc, "resolutions"))],
        code=code("contact"),
    message:
        "{wildcards.specimen}: contact states, part {wildcards.directions}.{wildcards.offsets}.{wildcards.resolutions}"
    script:
        "../scripts/contact.py"


def contact_parts_of(specimen):
    """Files of the contact jobs of a specimen."""
    counts = {key: range(len(slices)) for key, slices in parts_of(specimen).items()}
    return expand(rules.contact.output, specimen=specimen, **counts)


# What follows from the states of a specimen: closure curves and laws of area; box counts, dimension
# and clusters of every contact domain, what changes with resolution, lacunarity and generalised
# dimensions of the domains that are drawn; and the error of what is published, by source, for which
# some states are solved again on finer grids and in other windows. Seconds of work, so one job.
rule analysis:
    input:
        **inputs_of("closure"),
        parts=lambda wc: contact_parts_of(wc.specimen),
    output:
        **outputs_of("closure"),
    log:
        f"{RESULTS}/logs/analysis/{{specimen}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/analysis/{{specimen}}.tsv"
    resources:
        **asked_for("analysis"),
    params:
        **calling("closure"),
    message:
        "{wildcards.specimen}: closure, contact domains and their errors"
    script:
        "../scripts/stage.py"


# Realisations of an embedded specimen, its seed and those that follow, under a few loads.
rule ensemble:
    input:
        **inputs_of("ensemble"),
    output:
        **outputs_of("ensemble"),
    log:
        f"{RESULTS}/logs/ensemble/{{specimen}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/ensemble/{{specimen}}.tsv"
    wildcard_constraints:
        specimen=alternation(REALISATIONS),
    # As long as the sub-windows of a specimen, and the report waits for it.
    priority: 1
    resources:
        **asked_for("ensemble", states=lambda wc: REALISATIONS[wc.specimen]),
    params:
        **calling("ensemble"),
        recipe=lambda wc: recipe_named(known(wc)),
        realisations=lambda wc: REALISATIONS[wc.specimen],
    message:
        "{wildcards.specimen}: its ensemble"
    script:
        "../scripts/stage.py"


# Flow through the gaps of the solved states: sparse equations of all open cells, so a job of its own.
rule flow:
    input:
        **inputs_of("flow"),
        parts=lambda wc: contact_parts_of(wc.specimen),
    output:
        **outputs_of("flow"),
    log:
        f"{RESULTS}/logs/flow/{{specimen}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/flow/{{specimen}}.tsv"
    resources:
        **asked_for("flow"),
    params:
        **calling("flow"),
    message:
        "{wildcards.specimen}: aperture and transmissivity"
    script:
        "../scripts/stage.py"


# The report: strength, size laws, and what the paper says compared with what was found. They alone
# read friction angles, wall strengths and labels, and solve nothing.
rule strength:
    input:
        unpack(ensemble_of),
        **inputs_of("windows"),
    output:
        **outputs_of("windows"),
    log:
        f"{RESULTS}/logs/strength/{{specimen}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/strength/{{specimen}}.tsv"
    wildcard_constraints:
        specimen=kind_of(SLIDING, FLAT),
    resources:
        **asked_for("strength"),
    params:
        **calling("windows"),
    message:
        "{wildcards.specimen}: strength, size laws and the paper's statements"
    script:
        "../scripts/stage.py"


# Strength needs sliding.
use rule strength as size_laws_against_plane with:
    output:
        **outputs_of("windows", [SPECIMEN]),
    log:
        f"{RESULTS}/logs/strength/{{specimen}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/strength/{{specimen}}.tsv"
    wildcard_constraints:
        specimen=kind_of(FLAT, SLIDING),
    message:
        "{wildcards.specimen}: size laws and the paper's statements"


def strength_of(wildcards):
    """Strength of a joint that slides; none of a surface against a plane."""
    sliding = wildcards.specimen in SLIDING_NAMES
    return {"strength": SLIDING_FILES["strength"]} if sliding else {}


# Laboratory tests beside the computed curves. Little is solved: another hardness, or what has
# crushed under the largest pressure of a test.
rule measured:
    input:
        unpack(strength_of),
        **inputs_of("measured"),
    output:
        **outputs_of("measured"),
    log:
        f"{RESULTS}/logs/measured/{{specimen}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/measured/{{specimen}}.tsv"
    resources:
        **asked_for("analysis"),
    params:
        **calling("measured"),
        digests=lambda wc: test_digests(known(wc)),
    message:
        "{wildcards.specimen}: laboratory tests beside computed curves"
    script:
        "../scripts/stage.py"


# A measured map of contact goes straight to the analysis of domains.
rule contact_map:
    input:
        scan=lambda wc: ancient(str(MAPS[wc.map].lower)),
        coordinates=lambda wc: [ancient(str(path)) for path in MAPS[wc.map].coordinates],
    output:
        **outputs_of("contact_maps"),
    log:
        f"{RESULTS}/logs/contact_map/{{map}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/contact_map/{{map}}.tsv"
    resources:
        **fixed(2000, 10),
    params:
        options=lambda wc: OPTIONS[wc.map],
        label=lambda wc: LABELS[wc.map],
        digests=lambda wc: digests_of(MAPS[wc.map]),
        code=code("contact_map"),
    message:
        "{wildcards.map}: measured contact map and its dimension"
    script:
        "../scripts/contact_map.py"
