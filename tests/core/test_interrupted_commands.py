"""Commands interrupted in a compiled kernel end as interrupted."""

import pytest
from kernel_interrupts import fault_of_library, interrupt_in_kernel

from fractalcontact.core.errors import said_in_one_line


def test_a_command_that_is_interrupted_in_a_kernel_ends_as_interrupted():
    with pytest.raises(KeyboardInterrupt):
        said_in_one_line(interrupt_in_kernel)()


def test_other_errors_of_libraries_stay_what_they_are():
    with pytest.raises(SystemError, match="internal function"):
        said_in_one_line(fault_of_library)()
