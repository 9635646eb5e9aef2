"""Stages of the laboratory, see `fractalcontact.study.stages`: experiments, accuracy and speed."""

from fractalcontact.core.stage import EXPERIMENT, MEASUREMENT, Stage


def _experiment(name, title, function):
    return Stage(name, title, EXPERIMENT, function, member="surfaces")


STAGES = (
    _experiment(
        "roll_off",
        "rigid dilatancy of synthetic joints with and without a roll-off",
        "contactlab.experiments.roll_off:roll_off_effect",
    ),
    _experiment(
        "area_slope",
        "real contact area at light load, on surfaces with and without a roll-off",
        "contactlab.experiments.area_slope:area_slope",
    ),
    _experiment(
        "estimator_bias",
        "estimators of Delta_g on surfaces of known dimension",
        "contactlab.experiments.delta_g:estimator_bias",
    ),
    _experiment(
        "size_effect",
        "which exponent carries the size effect: resolution, size and geometry one by one",
        "contactlab.experiments.size_effect_test:size_effect_test",
    ),
    _experiment(
        "size_strength",
        "strength of sliding mated joints over their side, at equal v and at equal v/b",
        "contactlab.experiments.size_strength:size_strength",
    ),
    Stage(
        "speed",
        "error against time of solvers and cheaper models, one group per test problem",
        MEASUREMENT,
        "contactlab.accuracy.speed:speed",
        member="{scene}",
    ),
    Stage(
        "speed_growth",
        "time and memory of the solvers over sizes",
        MEASUREMENT,
        "contactlab.accuracy.growth:growth",
        ("speed",),
        member="surfaces",
    ),
    Stage(
        "convergence",
        "error against spacing where the solution is known, and Richardson's extrapolation",
        MEASUREMENT,
        "contactlab.accuracy.convergence:convergence",
        member="{problem}",
    ),
    Stage(
        "stability",
        "verdicts on the solvers by kind of test problem",
        MEASUREMENT,
        "contactlab.accuracy.stability:join",
        member="scenes",
    ),
    Stage(
        "elimination",
        "whether dropping points alone reaches the right contact set",
        MEASUREMENT,
        "contactlab.accuracy.elimination:elimination",
        member="scenes",
    ),
)
