# The size effect of a specimen.


# How mechanics changes with size, and the direct test of eq. 6: both solve sub-windows.
rule windows:
    input:
        **inputs_of("windows"),
    output:
        **outputs_of("windows"),
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
        **calling("windows"),
        settings=settings_read_by("windows"),
        solver=solver_read_by("windows"),
    script:
        "../scripts/stage.py"
