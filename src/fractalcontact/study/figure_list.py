"""Which figures there are: what the workflow must know of them before anything is drawn.

Apart from :mod:`figures.draw`, whose import brings matplotlib and xarray into every
process that reads the workflow.
"""

#: Figures of a joint that slides, and of a surface against a plane: module names, in order.
FIGURES = (
    "fig01_strength",
    "fig02_relief",
    "quality",
    "fig03_composite",
    "fig04_05_closure",
    "area_theories",
    "compliance",
    "conductance",
    "window_size",
    "fig06_07_dilatancy",
    "strength",
    "clusters",
    "fig08_prefractals",
    "fig09_box_counting",
    "domain_measures",
    "fig10_scaling",
    "size_test",
    "fig11_slope_angle",
    "fig12_evolution",
    "fig13_size_effect",
    "statements",
    "choices",
)
_NEEDS_SLIDING = (
    "fig11_slope_angle",
    "fig01_strength",
    "fig03_composite",
    "compliance",
    "fig06_07_dilatancy",
    "strength",
    "clusters",
)

#: Experiments on made surfaces that a study may ask for, with the figure of each: stage and key of
#: the configuration to module name. Their ``draw(atlas, names)`` takes all specimens of the study.
EXPERIMENTS = {
    "roll_off": "plateau",
    "area_slope": "area_slope",
    "dimension_test": "dimension_test",
    "estimator_bias": "estimator_bias",
}
#: Measurements of accuracy and speed that a study may ask for, with the figures of each: key of the
#: configuration to module names. They are drawn from an atlas of their own, as EXPERIMENTS are.
ACCURACY = {
    "speed": ("error_time", "error_time_fields", "time_size", "cheaper_models"),
    "convergence": ("convergence",),
    "stability": ("stability", "elimination"),
}


def figures_of(opposite):
    """Names of the figures that make sense for a specimen.

    Parameters
    ----------
    opposite : str
        "flat" for a surface against a plane; anything else slides.
    """
    return [name for name in FIGURES if opposite != "flat" or name not in _NEEDS_SLIDING]


def study_figures_of(experiments):
    """Names of the figures of a whole study.

    Parameters
    ----------
    experiments : container of str
        Those of :data:`EXPERIMENTS` it asks for, other names do not matter: its configuration.
    """
    return [figure for experiment, figure in EXPERIMENTS.items() if experiment in experiments]


def accuracy_figures_of(measurements):
    """Names of the figures of accuracy and speed.

    Parameters
    ----------
    measurements : container of str
        Those of :data:`ACCURACY` it asks for, other names do not matter: its configuration.
    """
    asked = [figures for key, figures in ACCURACY.items() if key in measurements]
    return [name for figures in asked for name in figures]
