# One face slid over the other: offsets, composite topographies, rigid dilatancy.


rule joint:
    input:
        rules.specimen.output,
    output:
        f"{RESULTS}/joints/{{specimen}}.nc",
    params:
        settings=settings_of,
        code=code("joint", "store"),
    log:
        f"{RESULTS}/logs/joint/{{specimen}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/joint/{{specimen}}.tsv"
    resources:
        mem_mb=1000,
        runtime=10,
    conda:
        "../../environment.yml"
    script:
        "../scripts/joint.py"
