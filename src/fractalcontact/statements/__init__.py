"""What the paper states, compared with the atlas of a study."""

from ..core.lazy import exports

__getattr__, __dir__, __all__ = exports(
    __name__,
    {
        "FAILS": ".findings",
        "HOLDS": ".findings",
        "ILL_POSED": ".judge",
        "NEARLY": ".findings",
        "PARTLY": ".findings",
        "Plateaus": ".sliding",
        "STATEMENTS": ".study",
        "Statement": ".judge",
        "UNDETERMINED": ".findings",
        "all_statements": ".judge",
        "judge_study": ".study",
    },
)
