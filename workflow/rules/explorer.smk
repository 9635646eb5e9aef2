# The explorer: every contact state of the study on one page.


rule explorer:
    input:
        rules.atlas.output[0],
    output:
        f"{RESULTS}/explorer.html",
    log:
        f"{RESULTS}/logs/explorer.log",
    benchmark:
        f"{RESULTS}/benchmarks/explorer.tsv"
    resources:
        mem_mb=doubled(3000),
        runtime=doubled(10),
    params:
        code=code("explorer"),
        templates=sources.digest(
            [
                *PACKAGE.glob("pages/templates/explorer*"),
                *PACKAGE.glob("pages/templates/page.*"),
            ],
            root=workflow.basedir,
        ),
    message:
        "the study: explorer of all contact states"
    script:
        "../scripts/explorer.py"
