"""What every variable of the atlas says about itself, and how the texts of strangers are shown."""


def cf_attrs(units, long_name):
    """Attributes of a variable, named as the CF conventions have them.

    Parameters
    ----------
    units, long_name : str

    Returns
    -------
    dict
    """
    return {"units": units, "long_name": long_name}


def printable(text, longest=None):
    """Text of strangers on one line: control characters escaped, the middle left out if it is long.

    Parameters
    ----------
    text : str
    longest : int, optional
        Characters.

    Returns
    -------
    str
    """
    text = "".join(c if c.isprintable() else ascii(c)[1:-1] for c in str(text))
    if longest is None or len(text) <= longest:
        return text
    half = (longest - 1) // 2
    return f"{text[:half]}…{text[-half:]}"
