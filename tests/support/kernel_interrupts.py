"""Faults as compiled kernels raise them."""


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
