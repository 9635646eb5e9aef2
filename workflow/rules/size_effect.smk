# The size effect of a specimen.


# States of sub-windows, and the direct test of eq. 6. Laws of size are made of them by the rule
# `analysis`, so that a friction angle solves nothing again.
rule windows:
    input:
        **inputs_of("window_states"),
    output:
        **outputs_of("window_states"),
    log:
        f"{RESULTS}/logs/windows/{{specimen}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/windows/{{specimen}}.tsv"
    # The longest of a specimen, and the others wait for it.
    priority: 1
    conda:
        "../../environment.yml"
    resources:
        mem_mb=lambda wc, attempt: 2000 * attempt,
        runtime=60,
    params:
        **calling("window_states"),
        settings=settings_read_by("window_states"),
        solver=solver_read_by("window_states"),
    script:
        "../scripts/stage.py"
