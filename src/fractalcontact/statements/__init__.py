"""What the paper states, compared with the atlas of a study."""

from ..core.lazy import exports

__getattr__, __dir__, __all__ = exports(
    __name__,
    {
        "FAILS": ".judge",
        "HOLDS": ".judge",
        "ILL_POSED": ".judge",
        "NEARLY": ".findings",
        "PARTLY": ".judge",
        "Plateaus": ".sliding",
        "STATEMENTS": ".study",
        "Statement": ".judge",
        "UNDETERMINED": ".judge",
        "all_statements": ".judge",
        "judge_study": ".study",
    },
)
