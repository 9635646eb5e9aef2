"""Write card, aperture map and page of a specimen from its own atlas."""

from dataclasses import replace
from pathlib import Path

from engine.job import job

from fractalcontact.cards.write import NEEDS as OF_CARDS
from fractalcontact.cards.write import write_cards
from fractalcontact.pages.result_page import NEEDS as OF_PAGES
from fractalcontact.pages.result_page import Place, write_specimen_pages
from fractalcontact.study.atlas_parts import Trees

with job(snakemake):
    atlas, params = Path(snakemake.input[0]), snakemake.params
    results = atlas.parent.parent
    # Reading the atlas is most of the work, so it is read once for both.
    trees = Trees(atlas, {*OF_CARDS, *OF_PAGES})
    write_cards(atlas, results, params.apertures, trees)
    place = replace(Place.of(results), atlas=atlas)
    write_specimen_pages(place, params.explored, trees)
