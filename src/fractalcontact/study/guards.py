"""Guard of the results of a study, checked before a run replaces any."""

from collections.abc import Iterable
from pathlib import Path

from ..core import checksums
from ..core.errors import InputError


def refuse_loss(results: Path | str, names: Iterable[str]) -> None:
    """Refuse to remove specimens from the atlas of a study, unless its user asks for it.

    A folder that is not mounted, or half copied, looks like one from which scans were removed.
    ``names`` are the specimens and contact maps that the study has now.
    """
    results = Path(results)
    places = [results, results / checksums.ASIDE]
    if not any((place / "atlas.nc").exists() for place in places):
        return
    listed = results / "specimens.txt"
    if listed.is_file():
        had = set(listed.read_text(encoding="utf-8").split())
    else:  # without a list, a specimen with any file counts
        stages = [place / stage for place in places for stage in ("specimens", "contact_maps")]
        had = {path.stem for stage in stages for path in stage.glob("*.nc")}
    lost = sorted(had - set(names))
    if lost:
        raise InputError(
            f"{results}/atlas.nc has specimens that the study no longer has: {', '.join(lost)}; "
            "put their scans back or, if they are to go, run 'make DROP=yes' (with snakemake: "
            "set FRACTALCONTACT_DROP=yes in the environment). The atlas was not changed"
        )
