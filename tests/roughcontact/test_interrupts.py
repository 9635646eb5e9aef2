"""Interrupts end as KeyboardInterrupt, also those that arrive in a compiled kernel."""

import numpy as np
import pytest

from fractalcontact.core.errors import said_in_one_line
from roughcontact import HalfSpace, solve_contact
from roughcontact.contact import solve


def interrupt_in_kernel(*arguments, **options):
    """Errors as numba raises them: the interrupt causes one of unpickling, that one of the call."""
    try:
        try:
            raise KeyboardInterrupt
        except KeyboardInterrupt as error:
            raise SystemError("unpickle returned a result with an exception set") from error
    except SystemError as error:
        raise SystemError("CPUDispatcher returned a result with an exception set") from error


def fault_of_library(*arguments, **options):
    raise SystemError("bad argument to an internal function")


def test_a_solve_that_is_interrupted_in_a_kernel_ends_as_interrupted(monkeypatch):
    space = HalfSpace((4, 4), 1.0, 1.0)
    monkeypatch.setattr(solve, "Bounds", interrupt_in_kernel)
    with pytest.raises(KeyboardInterrupt):
        solve_contact(np.eye(4), space, force=1.0)


def test_a_command_that_is_interrupted_in_a_kernel_ends_as_interrupted():
    with pytest.raises(KeyboardInterrupt):
        said_in_one_line(interrupt_in_kernel)()


def test_other_errors_of_libraries_stay_what_they_are():
    with pytest.raises(SystemError, match="internal function"):
        said_in_one_line(fault_of_library)()
