# Joint mechanics beside the contact states: parts of the window, made joints.


# How mechanics goes with size, and the direct test of eq. 6: both press parts of the window.
rule windows:
    input:
        specimen=rules.specimen.output.specimen,
        surface_dimension=rules.specimen.output.surface_dimension,
        joint=rules.specimen.output.joint,
    output:
        windows=f"{RESULTS}/windows/{{specimen}}.nc",
        size_test=f"{RESULTS}/size_test/{{specimen}}.nc",
    log:
        f"{RESULTS}/logs/windows/{{specimen}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/windows/{{specimen}}.tsv"
    conda:
        "../../environment.yml"
    resources:
        mem_mb=lambda wc, attempt: 2000 * attempt,
        runtime=60,
    params:
        settings=settings_of,
        solver=SOLVER,
        code=code("windows"),
    script:
        "../scripts/windows.py"


rule roll_off:
    output:
        f"{RESULTS}/roll_off/surfaces.nc",
    log:
        f"{RESULTS}/logs/roll_off.log",
    benchmark:
        f"{RESULTS}/benchmarks/roll_off.tsv"
    priority: 1
    conda:
        "../../environment.yml"
    resources:
        mem_mb=2000,
        runtime=30,
    params:
        joints=resolve_roll_off(config, SOURCE),
        code=code("roll_off"),
    script:
        "../scripts/roll_off.py"


rule area_slope:
    output:
        f"{RESULTS}/area_slope/surfaces.nc",
    log:
        f"{RESULTS}/logs/area_slope.log",
    benchmark:
        f"{RESULTS}/benchmarks/area_slope.tsv"
    # Short, and nothing waits for it but the end: it fills the core that has nothing else to do.
    priority: -1
    conda:
        "../../environment.yml"
    resources:
        mem_mb=2000,
        runtime=60,
    params:
        recipe=config.get("area_slope"),
        rtol=SOLVER["rtol"],
        code=code("area_slope"),
    script:
        "../scripts/area_slope.py"
