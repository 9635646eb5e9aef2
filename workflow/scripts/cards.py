"""Write the cards of all specimens from the atlas."""

from pathlib import Path

from _job import job

from fractalcontact.cards.write import write_cards

with job(snakemake) as log:
    atlas = Path(snakemake.input[0])
    log.info("%d cards", len(write_cards(atlas, atlas.parent)))
