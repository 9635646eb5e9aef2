"""Profiles of `make test-processors`: each takes effect, and a test that fails is named."""

import json
import subprocess
import sys

import pytest
from processors import PROFILES, Outcome, Processor, environment, main, table, this_processor

#: What the libraries of a process chose: numba's processor and numpy's features.
CHOSEN = """
import json
from numba.core.registry import cpu_target
from numpy._core._multiarray_umath import __cpu_features__ as features
print(json.dumps([
    cpu_target.target_context.codegen().magic_tuple()[1],
    sorted(name for name, present in features.items() if present),
]))
"""
ARM = Processor(False, ("NEON_FP16", "SVE"), frozenset({"NEON_FP16"}))
OLD = Processor(True, ("X86_V3", "X86_V4"), frozenset({"X86_V2"}))


def chosen(profile):
    """What they chose under a profile; warnings are errors."""
    command = [sys.executable, "-W", "error", "-c", CHOSEN]
    given = environment(profile, this_processor())
    return json.loads(subprocess.run(command, env=given, check=True, capture_output=True).stdout)


@pytest.mark.parametrize("name", [name for name in PROFILES if name != "native"])
def test_a_profile_takes_effect(name):
    processor, profile = this_processor(), PROFILES[name]
    if why := profile.missing(processor):
        pytest.skip(why)
    variables = profile.variables(processor)
    compiled_for, features = chosen(profile)
    assert compiled_for == variables["NUMBA_CPU_NAME"]
    disabled = variables.get("NPY_DISABLE_CPU_FEATURES", "").split()
    assert not set(disabled) & set(features)
    if name == "oldest":
        assert not set(processor.dispatched) & set(features)


def test_what_a_processor_cannot_run_is_said():
    missing = {name: profile.missing(ARM) for name, profile in PROFILES.items()}
    assert missing == {
        "native": "",
        "haswell": "for x86-64 processors alone",
        "without-avx512": "for x86-64 processors alone",
        "oldest": "",
    }
    assert PROFILES["oldest"].variables(ARM) == {
        "NUMBA_CPU_NAME": "generic",
        "NUMBA_CPU_FEATURES": "",
        "NPY_DISABLE_CPU_FEATURES": "NEON_FP16",
    }
    assert PROFILES["haswell"].missing(OLD) == "this processor has no AVX2"
    assert "NPY_DISABLE_CPU_FEATURES" not in PROFILES["oldest"].variables(OLD)


def test_the_table_names_what_failed_and_what_was_not_run():
    shown = table(
        {"native": Outcome(7, [], 61.2), "haswell": "no", "oldest": Outcome(5, ["a::b", "a::c"], 1)}
    )
    native, haswell, oldest, other = shown.splitlines()[1:]
    assert native.split() == ["native", "7", "0", "61"]
    assert haswell.split() == ["haswell", "-", "-", "-", "not", "run:", "no"]
    assert (oldest.split()[-1], other.split()) == ("a::b", ["a::c"])


@pytest.mark.parametrize(("body", "code"), [("assert True", 0), ("assert False", 1)])
def test_the_exit_code_says_whether_all_pass(tmp_path, capsys, body, code):
    file = tmp_path / "test_one.py"
    file.write_text(f"def test_one():\n    {body}\n", encoding="utf-8")
    words = ["-n0", "-p", "no:cacheprovider", str(file)]
    assert main(["--only", "native", "--", *words]) == code
    assert ("test_one::test_one" in capsys.readouterr().out) == bool(code)


def test_a_run_that_ends_before_its_tests_counts_as_failed(tmp_path, capsys):
    assert main(["--only", "native", "--", "-n0", str(tmp_path / "test_lost.py")]) == 1
    assert "pytest ended with exit code" in capsys.readouterr().out
