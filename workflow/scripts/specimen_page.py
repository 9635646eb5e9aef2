"""Write card, aperture map and page of a specimen from its own atlas."""

from dataclasses import replace
from pathlib import Path

from _job import job

from fractalcontact.cards.write import write_cards
from fractalcontact.pages.result_page import Place, write_specimen_pages

with job(snakemake):
    atlas, params = Path(snakemake.input[0]), snakemake.params
    results = atlas.parent.parent
    write_cards(atlas, results, params.apertures)
    write_specimen_pages(replace(Place.of(results), atlas=atlas), params.explored)
