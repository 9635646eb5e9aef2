"""What the paper states, compared with the atlas of a study."""

from ..core.lazy import exports

__getattr__, __dir__, __all__ = exports(
    __name__,
    {
        "FAILS": ".judge",
        "HOLDS": ".judge",
        "ILL_POSED": ".judge",
        "LOOSELY": ".findings",
        "NEARLY": ".findings",
        "ONCE": ".comparison",
        "PARTLY": ".judge",
        "QUANTITIES": ".comparison",
        "STATEMENTS": ".study",
        "Statement": ".judge",
        "UNDER_LOAD": ".comparison",
        "UNDETERMINED": ".judge",
        "UNGROUPED": ".comparison",
        "all_statements": ".judge",
        "compare_specimens": ".comparison",
        "compared_pressures": ".comparison",
        "judge_study": ".study",
        "specimen_row": ".comparison",
    },
)
