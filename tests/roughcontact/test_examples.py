"""Examples in docstrings of the solver."""

import doctest
import importlib

import pytest

#: Modules whose docstrings have examples.
MODULES = ("contact.path", "contact.solve", "elastic.halfspace")


@pytest.mark.parametrize("module", MODULES)
def test_examples_of_docstrings_give_what_they_say(module):
    failed, run = doctest.testmod(importlib.import_module(f"roughcontact.{module}"))
    assert run > 0
    assert failed == 0
