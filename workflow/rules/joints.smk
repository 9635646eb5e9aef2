# One face slid over the other: offsets, composite topographies, rigid dilatancy.


rule joint:
    input:
        rules.specimen.output,
    output:
        f"{RESULTS}/joints/{{specimen}}.nc",
    log:
        f"{RESULTS}/logs/joint/{{specimen}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/joint/{{specimen}}.tsv"
    conda:
        "../../environment.yml"
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        settings=settings_of,
        code=code("joint", "store"),
    script:
        "../scripts/joint.py"
