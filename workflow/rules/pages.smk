# The explorer, every contact state of the study on one page; and the result page: an index, a page a
# specimen and tables beside them.
from fractalcontact.pages import files as page_files


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
        **fixed(3000, 10),
    params:
        code=code("pages", "fractalcontact/pages"),
    message:
        "the study: explorer of all contact states"
    script:
        "../scripts/pages.py"


# Measured contact maps alone have no states to explore.
EXPLORER = list(rules.explorer.output) if SPECIMENS and not IN_PARTS else []
# The pages show specimens side by side, from an atlas that is one file.
RESULT_PAGE = (
    []
    if IN_PARTS
    else [
        *(f"{RESULTS}/{name}" for name in page_files.FILES),
        *expand(f"{RESULTS}/{page_files.SPECIMEN_PAGE}", specimen=SPECIMENS),
        *EXPLORER,
    ]
)


rule result_page:
    input:
        rules.atlas.output[0],
        lambda wildcards: all_figure_files(),
        # The index links to it where it is there.
        EXPLORER,
    output:
        [path for path in RESULT_PAGE if path not in EXPLORER],
    log:
        f"{RESULTS}/logs/result_page.log",
    benchmark:
        f"{RESULTS}/benchmarks/result_page.tsv"
    resources:
        **fixed(2000, 10),
    params:
        code=code("pages", "fractalcontact/pages"),
    message:
        "the study: result page"
    script:
        "../scripts/pages.py"


# `make report`: the pages, and what they are made of.
rule pages:
    input:
        lambda wildcards: RESULT_PAGE,
    message:
        "the result page of the study"
