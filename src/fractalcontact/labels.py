"""What every variable of the atlas says about itself."""

#: What follows the long name of an estimate at the ends of its interval, by ending of the name.
INTERVAL = {
    "": "",
    "_low": ", lower end of the 95 % interval",
    "_high": ", upper end of the 95 % interval",
}


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
