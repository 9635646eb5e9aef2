# The explorer, contact states of all specimens or of those named on one page; and the result page: an index, a page a
# specimen and tables beside them.
from fractalcontact.pages import files as page_files

#: Files with the stages of each specimen that are not in the atlas of the study.
PARTS = expand(SPECIMEN_ATLAS, specimen=SPECIMENS) if IN_PARTS else []
#: Specimens that the explorer shows.
EXPLORED = campaign.explored(config, SPECIMENS)


rule explorer:
    input:
        rules.atlas.output[0],
        PARTS,
    output:
        f"{RESULTS}/explorer.html",
    log:
        f"{RESULTS}/logs/explorer.log",
    benchmark:
        f"{RESULTS}/benchmarks/explorer.tsv"
    resources:
        **fixed(3000, 10),
    params:
        specimens=EXPLORED,
        code=code("pages", "fractalcontact/pages"),
    message:
        "the study: explorer of all contact states"
    script:
        "../scripts/pages.py"


# A card a specimen: constants with their intervals, which the page and other codes read; and its
# aperture map for other programs, which of many specimens `export_aperture` writes.
rule cards:
    input:
        rules.atlas.output[0],
        # Aperture maps are those of the jobs of contact, which the atlas rounds.
        PARTS or [path for specimen in SPECIMENS for path in contact_parts_of(specimen)],
    output:
        expand(f"{RESULTS}/{page_files.CARD}", specimen=SPECIMENS, ending=page_files.CARD_ENDINGS),
        expand(
            f"{RESULTS}/{page_files.APERTURE}",
            specimen=[] if IN_PARTS else SPECIMENS,
            ending=page_files.APERTURE_ENDINGS,
        ),
    log:
        f"{RESULTS}/logs/cards.log",
    benchmark:
        f"{RESULTS}/benchmarks/cards.tsv"
    resources:
        **fixed(1500, 10),
    params:
        code=code("cards", "fractalcontact/cards"),
    message:
        "the study: cards of its joints"
    script:
        "../scripts/cards.py"


CARDS = list(rules.cards.output) if SPECIMENS else []
# None of measured contact maps alone, nor of many specimens of which the study names none.
EXPLORER = list(rules.explorer.output) if EXPLORED else []
RESULT_PAGE = [
    *(f"{RESULTS}/{name}" for name in page_files.FILES),
    *expand(f"{RESULTS}/{page_files.SPECIMEN_PAGE}", specimen=SPECIMENS),
    *EXPLORER,
    *CARDS,
]


rule result_page:
    input:
        rules.atlas.output[0],
        PARTS,
        lambda wildcards: all_figure_files(),
        # The index links to it where it is there.
        EXPLORER,
        # Its first screen is that of the cards.
        CARDS,
    output:
        [path for path in RESULT_PAGE if path not in (*EXPLORER, *CARDS)],
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
