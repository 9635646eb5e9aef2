"""What every variable of the atlas says about itself, and how untrusted text is shown."""


def cf_attrs(units: str, long_name: str) -> dict[str, str]:
    """Attributes of a variable, named as the CF conventions have them.

    Parameters
    ----------
    units, long_name : str

    Returns
    -------
    dict
    """
    return {"units": units, "long_name": long_name}


def printable(text: object, longest: int | None = None) -> str:
    """Untrusted text on one line: control characters escaped, the middle left out if it is long.

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
