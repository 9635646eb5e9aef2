"""The tests on other processors than this one: what is compiled and chosen for them, here.

    python tests/support/processors.py [--only PROFILE ...] [-- FOLDER ...]

Compiled kernels, numpy, BLAS and the C library each choose instructions by the processor, and these
round differently: sums in another order, products with or without a fused addition. Each profile is
a set of environment variables under which all of them choose as they would elsewhere. The exit code
is 1 where a test fails under one of them.
"""

import argparse
import os
import platform
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as ET
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from places import ROOT

X86 = platform.machine().lower() in ("x86_64", "amd64")


@dataclass(frozen=True)
class Processor:
    """What numpy says of the processor that runs this.

    Attributes
    ----------
    x86 : bool
    dispatched : tuple of str
        Features for which numpy holds functions of their own.
    present : frozenset of str
        Those that this processor has.
    """

    x86: bool
    dispatched: tuple[str, ...]
    present: frozenset[str]


def this_processor() -> Processor:
    """The processor that runs this."""
    from numpy._core._multiarray_umath import __cpu_dispatch__, __cpu_features__

    present = frozenset(name for name, found in __cpu_features__.items() if found)
    return Processor(X86, tuple(__cpu_dispatch__), present)


def _native(processor):
    return {}


def _haswell(processor):
    return {"NUMBA_CPU_NAME": "haswell", "NUMBA_CPU_FEATURES": ""}


def _without_avx512(processor):
    wide = [name for name in processor.dispatched if "512" in name or name == "X86_V4"]
    return _haswell(processor) | _without(processor, wide) | {"OPENBLAS_CORETYPE": "Haswell"}


def _oldest(processor):
    plain = {"NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": ""}
    plain |= _without(processor, processor.dispatched)
    if not processor.x86:
        return plain
    return plain | {
        "NUMBA_CPU_NAME": "x86-64-v2",
        "OPENBLAS_CORETYPE": "Nehalem",
        "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA,-AVX512F",
    }


def _without(processor, features):
    """numpy without these features; one that this processor lacks would be warned of."""
    taken = [name for name in features if name in processor.present]
    return {"NPY_DISABLE_CPU_FEATURES": " ".join(taken)} if taken else {}


@dataclass(frozen=True)
class Profile:
    """A processor as the libraries see it.

    Attributes
    ----------
    name, reason : str
    variables : callable
        Environment variables for it on a :class:`Processor`.
    needs : frozenset of str, optional
        Features of numpy's names, any one of which says that its instructions can be run here.
    """

    name: str
    reason: str
    variables: Callable[[Processor], dict[str, str]]
    needs: frozenset[str] = frozenset()

    def missing(self, processor: Processor) -> str:
        """The reason why it cannot be had on a processor; empty if it can."""
        if not self.needs:
            return ""
        if not processor.x86:
            return "for x86-64 processors alone"
        if not self.needs & processor.present:
            return "this processor has no AVX2"
        return ""


#: numpy's names for AVX2 and what comes with it, since 2.4 and before.
_AVX2 = frozenset({"X86_V3", "AVX2"})
PROFILES = {
    profile.name: profile
    for profile in (
        Profile("native", "this machine as it is", _native),
        Profile(
            "haswell",
            "kernels compiled as for most x86-64 machines since 2013; numpy and BLAS as they are",
            _haswell,
            _AVX2,
        ),
        Profile(
            "without-avx512",
            "the same with numpy and BLAS: laptops, and most machines that run CI",
            _without_avx512,
            _AVX2,
        ),
        Profile(
            "oldest",
            "the oldest processor that numpy runs on, in all libraries: no AVX, no fused products",
            _oldest,
        ),
    )
}


@dataclass
class Outcome:
    """Tests under one profile."""

    passed: int
    failed: list[str]
    seconds: float


def outcome_of(report: Path, seconds: float) -> Outcome:
    """Counts and names from a report of pytest in JUnit's form."""
    passed, failed = 0, []
    for case in ET.parse(report).getroot().iter("testcase"):
        verdicts = {child.tag for child in case}
        if verdicts & {"failure", "error"}:
            failed.append(f"{case.get('classname')}::{case.get('name')}")
        elif "skipped" not in verdicts:
            passed += 1
    return Outcome(passed, failed, seconds)


def environment(profile: Profile, processor: Processor) -> dict[str, str]:
    """The environment of this process, changed to that of a profile."""
    return os.environ | {"OPENBLAS_NUM_THREADS": "1"} | profile.variables(processor)


def run_tests(profile: Profile, processor: Processor, words: list[str]) -> Outcome:
    """The tests under one profile, shown as they run."""
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.xml"
        command = [sys.executable, "-m", "pytest", "-q", "-n", "auto", f"--junitxml={report}"]
        begun = time.monotonic()
        status = subprocess.run(
            [*command, *words], cwd=ROOT, env=environment(profile, processor)
        ).returncode
        seconds = time.monotonic() - begun
        if not report.is_file():
            return Outcome(0, [f"pytest ended with exit code {status}"], seconds)
        outcome = outcome_of(report, seconds)
    if status and not outcome.failed:
        outcome.failed.append(f"pytest ended with exit code {status}")
    return outcome


def table(outcomes: dict[str, Outcome | str]) -> str:
    """A line a profile: passed, failed, seconds, failed tests; or the reason why it was not run."""
    lines = [f"{'profile':16}{'passed':>8}{'failed':>8}{'seconds':>9}  failed tests"]
    for name, found in outcomes.items():
        if isinstance(found, str):
            lines.append(f"{name:16}{'-':>8}{'-':>8}{'-':>9}  not run: {found}")
            continue
        counts = f"{found.passed:8}{len(found.failed):8}{found.seconds:9.0f}"
        first, *others = found.failed or [""]
        lines.append(f"{name:16}{counts}  {first}".rstrip())
        lines += [f"{'':43}{other}" for other in others]
    return "\n".join(lines)


def main(arguments: list[str] | None = None) -> int:
    """Run the tests under all profiles, or those that are named."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--only", action="append", choices=PROFILES, help="this profile alone")
    parser.add_argument("words", nargs="*", help="folders and options for pytest, after --")
    options = parser.parse_args(arguments)
    processor, outcomes = this_processor(), {}
    for name in options.only or PROFILES:
        profile = PROFILES[name]
        outcomes[name] = profile.missing(processor)
        if not outcomes[name]:
            print(f"\n{name}: {profile.reason}", flush=True)
            outcomes[name] = run_tests(profile, processor, options.words)
    print(f"\n{table(outcomes)}", flush=True)
    return int(any(isinstance(found, Outcome) and found.failed for found in outcomes.values()))


if __name__ == "__main__":
    sys.exit(main())
