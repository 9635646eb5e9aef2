"""Error of the flow solver."""


class FlowNotConverged(RuntimeError):
    """No flow whose mass balance closes was reached.

    Attributes
    ----------
    imbalance : float
        Bound on the error of the flow that the imbalance of its cells makes, a fraction of it.
    """

    def __init__(self, reason: str, imbalance: float):
        super().__init__(
            f"flow not solved: {reason}; the mass balance leaves {imbalance:.3g} of it open"
        )
        self.reason, self.imbalance = reason, imbalance

    def __reduce__(self):
        return type(self), (self.reason, self.imbalance)
