# The explorer, one page with the contact states of all specimens or of those named; and the result page,
# which is an index, a page a specimen and tables.
from fractalcontact.pages import files as page_files

#: Specimens that the explorer shows.
EXPLORED = campaign.explored(config, SPECIMENS)


def with_endings(path, endings):
    """Files of a specimen, one for each ending, such as "cards/{specimen}.{ending}"."""
    return expand(f"{RESULTS}/{path}", specimen="{specimen}", ending=endings)


rule explorer:
    input:
        rules.atlas.output[0],
        expand(SPECIMEN_ATLAS, specimen=EXPLORED) if CAMPAIGN else [],
    output:
        update(f"{RESULTS}/explorer.html"),
    log:
        f"{RESULTS}/logs/explorer.log",
    priority: PRIORITY["explorer"]
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


# Card of a specimen, constants with their intervals which the page and other codes read; its aperture map
# for other programs (in a campaign the command export_aperture writes it on demand); and its page. The job
# reads the specimen's own atlas alone, so that one more specimen writes no other card again.
rule card_and_page:
    input:
        SPECIMEN_ATLAS,
        # The page reads captions only. The job that wrote them made the pictures too.
        lambda wildcards: figure_files(known(wildcards), ["txt"]),
        # Aperture maps take the gaps from the contact jobs, because the atlas rounds them.
        lambda wildcards: [] if CAMPAIGN else contact_files_of(known(wildcards)),
    output:
        update(f"{RESULTS}/{page_files.SPECIMEN_PAGE}"),
        update(with_endings(page_files.CARD, page_files.CARD_ENDINGS)),
        update([] if CAMPAIGN else with_endings(page_files.APERTURE, page_files.APERTURE_ENDINGS)),
    log:
        f"{RESULTS}/logs/card_and_page/{{specimen}}.log",
    resources:
        mem_mb=doubled(1500),
        runtime=doubled(10),
    params:
        # The specimen itself, if the explorer shows it. Others would change this page.
        explored=lambda wildcards: [name for name in EXPLORED if name == wildcards.specimen],
        apertures=not CAMPAIGN,
        code=code("card_and_page", "fractalcontact/cards", "fractalcontact/pages"),
    message:
        "{wildcards.specimen}: card and page"
    script:
        "../scripts/card_and_page.py"


PAGES = expand(rules.card_and_page.output, specimen=SPECIMENS)
# There is no explorer of measured contact maps alone, nor of a campaign that names no specimen for it.
EXPLORER = list(rules.explorer.output) if EXPLORED else []
INDEX = [f"{RESULTS}/{name}" for name in page_files.FILES]
RESULT_PAGE = [*INDEX, *EXPLORER, *PAGES]


rule result_page:
    input:
        rules.atlas.output[0],
        expand(SPECIMEN_ATLAS, specimen=SPECIMENS) if CAMPAIGN else [],
        lambda wildcards: all_figure_files(["txt"]),
        # The first screen of the index takes its numbers from the cards.
        PAGES,
    output:
        update(INDEX),
    log:
        f"{RESULTS}/logs/result_page.log",
    resources:
        mem_mb=doubled(2000),
        runtime=doubled(10),
    params:
        # The index links to the explorer, which may be made later.
        explored=EXPLORED,
        code=code("result_page", "fractalcontact/pages"),
    message:
        "the study: result page"
    script:
        "../scripts/result_page.py"


# Target of `make report`: the pages, and everything that they are made of.
rule pages:
    input:
        RESULT_PAGE,
    message:
        "the result page of the study"
