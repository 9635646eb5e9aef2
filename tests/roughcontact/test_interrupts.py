"""Interrupts end as KeyboardInterrupt, also those that arrive in a compiled kernel."""

import numpy as np
import pytest
from kernel_interrupts import fault_of_library, interrupt_in_kernel

from roughcontact import HalfSpace, solve_contact
from roughcontact.contact import solve
from roughcontact.errors import interruptible


def test_a_solve_that_is_interrupted_in_a_kernel_ends_as_interrupted(monkeypatch):
    space = HalfSpace((4, 4), 1.0, 1.0)
    monkeypatch.setattr(solve, "Bounds", interrupt_in_kernel)
    with pytest.raises(KeyboardInterrupt):
        solve_contact(np.eye(4), space, force=1.0)


def test_other_errors_of_libraries_stay_what_they_are():
    with pytest.raises(SystemError, match="internal function"):
        interruptible()(fault_of_library)()
