"""Report of a specimen: strength, size laws and verdicts, without a solve."""

from dataclasses import asdict

import xarray as xr

from ..core.datasets import titled
from ..core.settings import ReportSettings
from ..statements.comparison import specimen_row
from ..statements.judge import judge
from ..states.model_validity import model_validity
from .strength import strength_stages

#: Stages that strength and size laws are made of.
OF_STRENGTH = (
    "specimens",
    "surface_dimension",
    "joints",
    "window_states",
    "size_test",
    "dilatancy",
)


@titled(
    windows="closure, roughness and strength of sub-windows against their size",
    strength="dilatancy and friction angles, shear strength",
    elastic_model=(
        "verdict on the elastic model: real mean pressure against strength, slope of the faces"
    ),
    statements="the paper's statements, and their verdicts",
    comparison="quantities of a specimen for comparison with others, with their errors",
)
def report_stages(settings: ReportSettings, **stages: xr.Dataset) -> dict[str, xr.Dataset]:
    """Stages that solve nothing: a friction angle, wall strength or label makes these alone again.

    Parameters
    ----------
    settings : ReportSettings
    **stages : xr.Dataset
        Of one specimen by name, those that the rule ``strength`` takes.

    Returns
    -------
    dict of str to xr.Dataset
        By stage: those of :func:`stages.strength.strength_stages`, and elastic_model, statements
        and comparison.
    """
    strength = strength_stages(**{name: stages[name] for name in OF_STRENGTH}, settings=settings)
    stated, known = asdict(settings), stages | strength
    return {
        **strength,
        "elastic_model": model_validity(known["area"], known["scaling"], settings.material),
        "statements": judge(known, stated),
        "comparison": specimen_row(known, stated),
    }
