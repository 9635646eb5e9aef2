# Contact states of the composite topographies, which cost most of a study, and their analysis: closure,
# dilatancy, box counts and renormalisation; flow; strength (sections 4 to 6 of the paper).


def grain(key, n):
    """Slices of n items for the jobs, each with as many items as the study's `grain` states."""
    size = config.get("grain", {}).get(key, "all")
    size = max(n, 1) if size == "all" else size
    return [slice(start, min(start + size, n)) for start in range(0, n, size)]


def blocks_of(name):
    """Slices of the directions, offsets and resolutions of a specimen, one for each block of jobs."""
    stated = SETTINGS[name]
    return {
        "direction": grain("directions", len(stated.contact_directions)),
        # The scan may turn out to have fewer offsets; a job without any writes an empty part.
        "offset": grain("offsets", max_offsets(name)),
        "resolution": grain("resolutions", len(stated.resolutions)),
    }


def block_of(wildcards, key):
    """Slice of the directions, offsets or resolutions that a contact job takes."""
    number = int(wildcards[f"{key}_block"])
    return blocks_of(known(wildcards))[key][number]


# Offset x load states of the pre-fractals at several resolutions. One job takes as many directions,
# offsets and resolutions as the study's `grain` says, with all their loads. File D.O.R.nc has the D-th
# block of directions, the O-th of offsets and the R-th of resolutions, counted from 0. The pre-fractals,
# which are the composite topography at coarser resolutions, are made inside the job and not stored.
rule contact:
    input:
        specimen=rules.roughness_and_composite.output.specimens,
        joint=rules.roughness_and_composite.output.joints,
    output:
        f"{RESULTS}/contact/{{specimen}}/{{direction_block}}.{{offset_block}}.{{resolution_block}}.nc",
    log:
        f"{RESULTS}/logs/contact/{{specimen}}/{{direction_block}}.{{offset_block}}.{{resolution_block}}.log",
    resources:
        mem_mb=memory("contact"),
        runtime=minutes("contact"),
    params:
        settings=settings_of(settings.ContactSettings),
        solver=SOLVER,
        directions=lambda wc: SETTINGS[known(wc)].contact_directions[block_of(wc, "direction")],
        offsets=lambda wc: block_of(wc, "offset"),
        resolutions=lambda wc: SETTINGS[known(wc)].resolutions[block_of(wc, "resolution")],
        code=code("contact"),
    message:
        "{wildcards.specimen}: contact states of pre-fractals, block {wildcards.direction_block}.{wildcards.offset_block}.{wildcards.resolution_block}"
    script:
        "../scripts/contact.py"


def contact_files_of(name):
    """Files of the contact jobs of a specimen."""
    numbers = {f"{key}_block": range(len(slices)) for key, slices in blocks_of(name).items()}
    return expand(rules.contact.output, specimen=name, **numbers)


def contact_files(wildcards):
    """Files of the contact jobs of a specimen, as an input of rules."""
    return contact_files_of(known(wildcards))


# Realisations of a surface that the study makes (its seed and those that follow), or twins of a scan,
# which are random surfaces with its spectrum. Their spread enters the errors on the card and in tables. The
# job takes about as long as `windows`, and closure_and_box_counts waits for it.
rule ensemble:
    input:
        specimens=rules.roughness_and_composite.output.specimens,
        joints=rules.roughness_and_composite.output.joints,
    output:
        f"{RESULTS}/ensemble/{{specimen}}.nc",
    log:
        f"{RESULTS}/logs/ensemble/{{specimen}}.log",
    wildcard_constraints:
        specimen=alternation(ENSEMBLES),
    priority: PRIORITY["ensemble"]
    resources:
        mem_mb=memory("ensemble", states=lambda name: ENSEMBLES[name]),
        runtime=minutes("ensemble", states=lambda name: ENSEMBLES[name]),
    params:
        settings=settings_of(settings.EnsembleSettings),
        solver=SOLVER,
        recipe=lambda wc: None if wc.specimen in TWINS else recipe_named(known(wc)),
        realisations=lambda wc: ENSEMBLES[wc.specimen],
        code=code("ensemble"),
    message:
        "{wildcards.specimen}: its ensemble"
    script:
        "../scripts/ensemble.py"


#: An input of rules: the ensemble of a specimen, where the study wants one.
ENSEMBLE = branch(lambda wildcards: wildcards.specimen in ENSEMBLES, then=rules.ensemble.output[0])


# Closure, dilatancy, contact area, box counts and renormalisation of the states that `contact` solved,
# and the errors of numbers on the card and in tables, by source. Some states are solved again: on finer
# grids and in other windows for the errors, and on unloading for `branches`. Split into four jobs, each would
# read all states, and config/smoke.yaml would take 5 % more processor time. `choices` says which states
# were solved, how exactly, and why; contact/{specimen}.nc has the contact domains of
# all contact jobs.
rule closure_and_box_counts:
    input:
        specimens=rules.roughness_and_composite.output.specimens,
        surface_dimension=rules.roughness_and_composite.output.surface_dimension,
        joints=rules.roughness_and_composite.output.joints,
        parts=contact_files,
        ensemble=ENSEMBLE,
    output:
        closure=f"{RESULTS}/closure/{{specimen}}.nc",
        dilatancy=f"{RESULTS}/dilatancy/{{specimen}}.nc",
        area=f"{RESULTS}/area/{{specimen}}.nc",
        domains=f"{RESULTS}/domains/{{specimen}}.nc",
        contact=f"{RESULTS}/contact/{{specimen}}.nc",
        scaling=f"{RESULTS}/scaling/{{specimen}}.nc",
        domain_measures=f"{RESULTS}/domain_measures/{{specimen}}.nc",
        branches=f"{RESULTS}/branches/{{specimen}}.nc",
        choices=f"{RESULTS}/choices/{{specimen}}.nc",
        error_budget=f"{RESULTS}/error_budget/{{specimen}}.nc",
    log:
        f"{RESULTS}/logs/closure_and_box_counts/{{specimen}}.log",
    resources:
        mem_mb=memory("closure_and_box_counts"),
        runtime=minutes("closure_and_box_counts"),
    params:
        settings=settings_of(settings.StateSettings),
        solver=SOLVER,
        code=code("closure_and_box_counts"),
    message:
        "{wildcards.specimen}: closure, dilatancy, box counts, renormalisation, and their errors"
    script:
        "../scripts/closure_and_box_counts.py"


# Flow through the apertures. It solves sparse equations of all open cells, so it is a job of its own.
rule flow:
    input:
        specimens=rules.roughness_and_composite.output.specimens,
        joints=rules.roughness_and_composite.output.joints,
        closure=rules.closure_and_box_counts.output.closure,
        branches=rules.closure_and_box_counts.output.branches,
        error_budget=rules.closure_and_box_counts.output.error_budget,
        parts=contact_files,
    output:
        flow=f"{RESULTS}/flow/{{specimen}}.nc",
    log:
        f"{RESULTS}/logs/flow/{{specimen}}.log",
    resources:
        mem_mb=memory("flow"),
        runtime=minutes("flow"),
    params:
        settings=settings_of(settings.JointSettings),
        solver=SOLVER,
        code=code("flow"),
    message:
        "{wildcards.specimen}: aperture and transmissivity"
    script:
        "../scripts/flow.py"


# Contact of sub-windows, for the size effect. It is one of the longest jobs of a specimen and is begun early,
# since `strength` waits for it. `strength` summarises window_states in windows/{specimen}.nc.
rule windows:
    input:
        specimens=rules.roughness_and_composite.output.specimens,
        joints=rules.roughness_and_composite.output.joints,
    output:
        window_states=f"{RESULTS}/window_states/{{specimen}}.nc",
        size_test=f"{RESULTS}/size_test/{{specimen}}.nc",
    log:
        f"{RESULTS}/logs/windows/{{specimen}}.log",
    priority: PRIORITY["windows"]
    resources:
        mem_mb=memory("windows"),
        runtime=minutes("windows"),
    params:
        settings=settings_of(settings.WindowSettings),
        solver=SOLVER,
        code=code("windows"),
    message:
        "{wildcards.specimen}: contact states of sub-windows, and eq. 6 of the paper"
    script:
        "../scripts/windows.py"


# Shear strength, size laws and the comparison with the paper. Of the jobs that compute, this one alone reads
# friction angle, wall strength, label and group. A change of these makes the atlas and the figures again
# too. It solves no contact.
rule strength:
    input:
        specimens=rules.roughness_and_composite.output.specimens,
        surface_dimension=rules.roughness_and_composite.output.surface_dimension,
        joints=rules.roughness_and_composite.output.joints,
        window_states=rules.windows.output.window_states,
        size_test=rules.windows.output.size_test,
        closure=rules.closure_and_box_counts.output.closure,
        dilatancy=rules.closure_and_box_counts.output.dilatancy,
        area=rules.closure_and_box_counts.output.area,
        domains=rules.closure_and_box_counts.output.domains,
        scaling=rules.closure_and_box_counts.output.scaling,
        domain_measures=rules.closure_and_box_counts.output.domain_measures,
        error_budget=rules.closure_and_box_counts.output.error_budget,
        ensemble=ENSEMBLE,
    output:
        windows=f"{RESULTS}/windows/{{specimen}}.nc",
        strength=f"{RESULTS}/strength/{{specimen}}.nc",
        elastic_model=f"{RESULTS}/elastic_model/{{specimen}}.nc",
        statements=f"{RESULTS}/statements/{{specimen}}.nc",
        comparison=f"{RESULTS}/comparison/{{specimen}}.nc",
    log:
        f"{RESULTS}/logs/strength/{{specimen}}.log",
    wildcard_constraints:
        specimen=names_of(SLIDING, FLAT),
    resources:
        mem_mb=memory("strength"),
        runtime=minutes("strength"),
    params:
        settings=settings_of(settings.ReportSettings),
        code=code("strength"),
    message:
        "{wildcards.specimen}: strength, size laws and the paper's statements"
    script:
        "../scripts/strength.py"


# The same without strength, for a specimen that does not slide: a surface against a plane, or an aperture map.
use rule strength as size_laws_against_plane with:
    output:
        windows=f"{RESULTS}/windows/{{specimen}}.nc",
        elastic_model=f"{RESULTS}/elastic_model/{{specimen}}.nc",
        statements=f"{RESULTS}/statements/{{specimen}}.nc",
        comparison=f"{RESULTS}/comparison/{{specimen}}.nc",
    log:
        f"{RESULTS}/logs/size_laws_against_plane/{{specimen}}.log",
    wildcard_constraints:
        specimen=names_of(FLAT, SLIDING),
    message:
        "{wildcards.specimen}: size laws and the paper's statements"


# Tests of the joint in a real laboratory beside the computed curves. The job solves contact only for
# another hardness, or for what has crushed under the largest pressure of a test.
rule measured:
    input:
        specimens=rules.roughness_and_composite.output.specimens,
        joints=rules.roughness_and_composite.output.joints,
        closure=rules.closure_and_box_counts.output.closure,
        dilatancy=rules.closure_and_box_counts.output.dilatancy,
        error_budget=rules.closure_and_box_counts.output.error_budget,
        flow=rules.flow.output.flow,
        strength=branch(
            lambda wildcards: wildcards.specimen in SLIDING, then=rules.strength.output.strength
        ),
    output:
        measured=f"{RESULTS}/measured/{{specimen}}.nc",
    log:
        f"{RESULTS}/logs/measured/{{specimen}}.log",
    wildcard_constraints:
        specimen=alternation(TESTED),
    resources:
        mem_mb=memory("closure_and_box_counts"),
        runtime=minutes("closure_and_box_counts"),
    params:
        settings=settings_of(settings.MeasuredSettings),
        solver=SOLVER,
        digests=lambda wc: PLAN.digests(*(test.file for test in SETTINGS[known(wc)].measured)),
        code=code("measured"),
    message:
        "{wildcards.specimen}: tests in a real laboratory beside computed curves"
    script:
        "../scripts/measured.py"
