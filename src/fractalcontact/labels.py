"""What every variable of the atlas says about itself."""


def about(units, long_name):
    """Attributes of a variable, named as the CF conventions have them.

    Parameters
    ----------
    units, long_name : str

    Returns
    -------
    dict
    """
    return {"units": units, "long_name": long_name}
