# The explorer, contact states of all specimens or of those named on one page; and the result page: an
# index, a page a specimen and tables beside them.
from fractalcontact.pages import files as page_files

#: Specimens that the explorer shows.
EXPLORED = campaign.explored(config, SPECIMENS)


def with_endings(path, endings):
    """Files of a specimen, one an ending: "cards/{specimen}.{ending}" with ["yaml", "json"], say."""
    return expand(f"{RESULTS}/{path}", specimen="{specimen}", ending=endings)


rule explorer:
    input:
        rules.atlas.output[0],
        expand(SPECIMEN_ATLAS, specimen=EXPLORED) if IN_PARTS else [],
    output:
        # `update`: what readers have stays until the new file takes its place.
        update(f"{RESULTS}/explorer.html"),
    log:
        f"{RESULTS}/logs/explorer.log",
    # After the figures: beside the result page, no core has nothing to do at the end.
    priority: -4
    resources:
        mem_mb=doubled(3000),
        runtime=doubled(10),
    params:
        explored=EXPLORED,
        code=code("explorer", "fractalcontact/pages"),
    message:
        "the study: explorer of all contact states"
    script:
        "../scripts/explorer.py"


# The card of a specimen, constants with their intervals which the page and other codes read; its
# aperture map for other programs (in a campaign the command export_aperture writes it on demand); and its
# page. All from its own atlas: one more specimen writes no other's again.
rule card_and_page:
    input:
        SPECIMEN_ATLAS,
        # Captions stand for the pictures, of which no page is made: the same job leaves both.
        lambda wildcards: figure_files(known(wildcards), ["txt"]),
        # Aperture maps are those of the jobs of contact, which the atlas rounds.
        lambda wildcards: [] if IN_PARTS else contact_files_of(known(wildcards)),
    output:
        update(f"{RESULTS}/{page_files.SPECIMEN_PAGE}"),
        update(with_endings(page_files.CARD, page_files.CARD_ENDINGS)),
        update([] if IN_PARTS else with_endings(page_files.APERTURE, page_files.APERTURE_ENDINGS)),
    log:
        f"{RESULTS}/logs/card_and_page/{{specimen}}.log",
    resources:
        mem_mb=doubled(1500),
        runtime=doubled(10),
    params:
        # Of itself alone: one specimen more or less changes no other's page.
        explored=lambda wildcards: [name for name in EXPLORED if name == wildcards.specimen],
        apertures=not IN_PARTS,
        code=code("card_and_page", "fractalcontact/cards", "fractalcontact/pages"),
    message:
        "{wildcards.specimen}: card and page"
    script:
        "../scripts/card_and_page.py"


PAGES = expand(list(rules.card_and_page.output), specimen=SPECIMENS)
# None of measured contact maps alone, nor of many specimens of which the study names none.
EXPLORER = list(rules.explorer.output) if EXPLORED else []
INDEX = [f"{RESULTS}/{name}" for name in page_files.FILES]
RESULT_PAGE = [*INDEX, *EXPLORER, *PAGES]


rule result_page:
    input:
        rules.atlas.output[0],
        expand(SPECIMEN_ATLAS, specimen=SPECIMENS) if IN_PARTS else [],
        lambda wildcards: [path for path in all_figure_files() if path.endswith(".txt")],
        # Its first screen is that of the cards.
        PAGES,
    output:
        update(INDEX),
    log:
        f"{RESULTS}/logs/result_page.log",
    resources:
        mem_mb=doubled(2000),
        runtime=doubled(10),
    params:
        # The index links to the explorer, which may be made after it or beside it.
        explored=EXPLORED,
        code=code("result_page", "fractalcontact/pages"),
    message:
        "the study: result page"
    script:
        "../scripts/result_page.py"


# `make report`: the pages, and what they are made of.
rule pages:
    input:
        lambda wildcards: RESULT_PAGE,
    message:
        "the result page of the study"
