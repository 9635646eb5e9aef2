# The result page: an index with a page a specimen, tables beside it, and the explorer.

PAGES = [f"{RESULTS}/{name}" for name in result_page.FILES]
SPECIMEN_PAGES = expand(f"{RESULTS}/pages/{{specimen}}.html", specimen=SPECIMENS)


rule result_page:
    input:
        atlas=rules.atlas.output[0],
        figures=lambda wildcards: all_figure_files(),
    output:
        *PAGES,
        *SPECIMEN_PAGES,
    log:
        f"{RESULTS}/logs/result_page.log",
    benchmark:
        f"{RESULTS}/benchmarks/result_page.tsv"
    conda:
        "../../environment.yml"
    resources:
        mem_mb=2000,
        runtime=10,
    params:
        code=code("result_page"),
    script:
        "../scripts/result_page.py"


# `make report`: the pages alone, and what they are made of.
rule report:
    input:
        PAGES,
        SPECIMEN_PAGES,
    message:
        "the result page of the study"
