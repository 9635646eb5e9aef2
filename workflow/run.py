"""Start of a study, which `make` calls: checks beforehand, then Snakemake.

python workflow/run.py STUDY [--dry-run] [--profile NAME] [--full] [--verbose] -- WORDS

WORDS are options and targets of Snakemake. The study is first read as plain data, because Snakemake
runs Python code in a study that says `__use_yte__: true`. Leftovers of a killed run are removed and
damaged files are set aside. When the run is told to end, it ends all jobs. The terminal gets a line
a job, from the logger plugin in workflow/engine; Snakemake's own words are in .snakemake/log.
"""

import argparse
import contextlib
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
# Import the code of this checkout, which may have been moved since its environment was installed.
sys.path.insert(0, str(ROOT / "src"))
from engine import running
from engine.cluster import left_in_queue

from fractalcontact.core import checksums
from fractalcontact.core.atomic import sweep
from fractalcontact.core.errors import InputError
from fractalcontact.study.documents import read_study, study_name
from fractalcontact.study.scan_files import list_scans

#: Seconds to wait for another run, which may only be looking at its results; and seconds within
#: which jobs must end when they are told to.
WAIT, GRACE, CLUSTER_GRACE = 3, 20, 120
#: Characters that a shell does not take literally.
SPLITS = r"[\s'\"\\$`&;|<>()*?\[\]#!{}]"
#: Environment variable with the process number of `make`, if `make` started this.
MAKE = "FRACTALCONTACT_MAKE"
#: Free megabytes below which no study begins; the default one makes some 100.
MIN_FREE = 50


def main():
    """Run the study of the command line; an error of input is one sentence."""
    options, passed = _options()
    try:
        _require_plain_path()
        study = read_study(options.study)
        name = study_name(study, options.study)
        _require_past(Path(str(study.get("scans", "scans"))))
        _name_own_study(study, options.study)
        results = Path("results") / (f"{name}_full" if options.full else name)
        if options.dry_run:
            for path, why in _spoilt(results):
                _say(f"{path}: {why}; a run sets it aside, and makes it again if needed")
        else:
            _require_room(results)
            _clean(options, results)
        status = _run([*_command(options, name), *passed], options, results)
        if not (status or options.dry_run):
            _name_leftovers(results)
            _name_page(results)
    except (InputError, OSError) as error:  # a result, the guard or a folder that cannot be used
        _say(f"error: {error}")
        _leave(1)
    if status and not options.dry_run:
        _say("the study did not finish; what is done is kept, and 'make' goes on from there")
    _leave(status)


def _options():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("study", type=Path)
    parser.add_argument("--profile", default="default", help="of workflow/profiles")
    # Loaded libraries survive a fork on Linux, but not reliably elsewhere.
    forks = "fractalcontact" if sys.platform == "linux" else "local"
    parser.add_argument("--executor", default=forks, help="or local, that of Snakemake")
    parser.add_argument("--full", action="store_true", help="at full cost, beside the study")
    parser.add_argument("--dry-run", action="store_true", help="say what would be done")
    parser.add_argument("--verbose", action="store_true", help="all that Snakemake says")
    own = sys.argv[1:]
    passed = own[own.index("--") + 1 :] if "--" in own else []
    return parser.parse_args(own[: own.index("--")] if "--" in own else own), passed


def _command(options, name):
    return [
        *(sys.executable, "-m", "snakemake", "--configfile", str(options.study)),
        *("--workflow-profile", f"workflow/profiles/{options.profile}"),
        *(() if options.verbose else ("--logger", "fractalcontact")),
        *(("--executor", options.executor) if options.profile == "default" else ()),
        *(("--config", f"study={name}_full", "accuracy=full") if options.full else ()),
        *(("--dry-run",) if options.dry_run else ()),
    ]


def _require_plain_path():
    """Refuse an interpreter whose path a shell splits: Snakemake does not quote it in commands."""
    if re.search(SPLITS, sys.executable):
        raise InputError(
            f"{sys.executable}: Snakemake cannot start scripts from a folder whose name has spaces "
            "or quotes in it; move the checkout to one without (nothing is made again for that)"
        )


def _require_past(scans):
    """Refuse scans from the future: Snakemake refuses a result that is older than its scan."""
    for path in sorted(scans.glob("*")):
        if path.is_file() and path.stat().st_mtime > time.time() + 1:
            raise InputError(
                f"{path}: dated ahead of this machine's clock, so that no result could be younger "
                f"than it; set the clock, or date the file today: touch '{path}'"
            )


def _require_room(results):
    """Refuse results without room for a study, or in a folder that is not writable."""
    folder = next(path for path in (results, *results.parents) if path.exists())
    if not folder.is_dir() or not os.access(folder, os.W_OK | os.X_OK):
        raise InputError(f"{folder}: no folder that can be written to; allow it (chmod u+w)")
    free = shutil.disk_usage(folder).free / 2**20
    if free < MIN_FREE:
        raise InputError(
            f"{folder}: {free:.0f} MB free on its disk, less than the {MIN_FREE} MB that a study "
            "needs at least; make room"
        )


def _clean(options, results):
    """Remove leftovers of a killed run and set damaged files aside, if no other run is active."""
    guard, has_locks = running.alone(WAIT)
    if guard is None:
        raise InputError(
            "another run is at work in this folder (or jobs that a killed one left, which end "
            "by themselves); wait for it, or end it first"
        )
    if left := left_in_queue(f"workflow/profiles/{options.profile}"):
        raise InputError(
            f"jobs of a run that was killed are still in the cluster's queue ({', '.join(left)}); "
            f"wait until they have ended, or end them: scancel {' '.join(left)}"
        )
    if has_locks:
        shutil.rmtree(".snakemake/locks", ignore_errors=True)
        for path in sweep(results):
            _say(f"removed {path}, which a killed run left unfinished")
        for path, why in list(_spoilt(results)):
            aside = checksums.set_aside(results, path)
            _say(f"{path}: {why}; moved to {aside}, and made again if needed")
    else:
        _say("this file system knows no locks: what a killed run may have left stays")
    running.share(guard)


def _spoilt(results):
    """Files that differ from their checksums or have none, and the reason."""
    digests = checksums.Digests()
    checked = checksums.check(results, digests.of)
    digests.save()
    yield from ((path, "damaged or replaced after it was made") for path in checked.damaged)
    yield from ((path, "without a checksum") for path in checked.unrecorded)


def _run(command, options, results):
    """Exit code of Snakemake, all of whose processes end with this one."""
    # Snakemake finds its plugins there, and the plugins find the modules beside them.
    path = [str(ROOT / name) for name in ("src", "workflow", "workflow/engine")]
    path += filter(None, [os.environ.get("PYTHONPATH")])
    variables = {"PYTHONPATH": os.pathsep.join(path), "FRACTALCONTACT_RESULTS": str(results)}
    cluster, child = options.profile != "default", None
    if options.executor == "fractalcontact" and not (cluster or options.dry_run):
        variables["FRACTALCONTACT_SERVER"] = "yes"  # the server of jobs loads beside Snakemake
    try:
        _answer_signals(_stop)
        child = subprocess.Popen(
            command, env=os.environ | variables, stderr=subprocess.PIPE, start_new_session=True
        )
        for line in child.stderr:
            if options.verbose or not line.startswith(b"Using workflow specific profile"):
                sys.stderr.buffer.write(line)
                sys.stderr.flush()
        status = child.wait()
    except _Stopped as stopped:
        _answer_signals(signal.SIG_IGN)
        _say("interrupted: jobs end, and 'make' goes on from there")
        if child is not None:
            _end(child, cluster=cluster)
        sys.exit(128 + stopped.args[0])
    _answer_signals(signal.SIG_DFL)
    return status if status >= 0 else 128 - status


class _Stopped(Exception):
    """Signal that told this process to end; the argument is its number."""


def _stop(number, frame):
    raise _Stopped(number)


def _answer_signals(how):
    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGQUIT):
        signal.signal(number, how)


def _end(child, *, cluster):
    """Tell all processes of the run to end, and kill those that do not.

    Only Snakemake takes back its jobs on a cluster, and only when it is interrupted.
    """
    with contextlib.suppress(ProcessLookupError, subprocess.TimeoutExpired):
        if cluster:
            child.send_signal(signal.SIGINT)
        else:
            os.killpg(child.pid, signal.SIGTERM)
        child.wait(CLUSTER_GRACE if cluster else GRACE)
    with contextlib.suppress(ProcessLookupError):
        os.killpg(child.pid, signal.SIGKILL)
    child.wait()


def _leave(status):
    """Exit, and after a failure end `make` too, which would add a line of its own."""
    if status and MAKE in os.environ:
        os.kill(int(os.environ[MAKE]), signal.SIGPIPE)
    sys.exit(status)


def _name_own_study(study, source):
    """Say how to compute the user's scans without the synthetic specimens of a study."""
    folder = study.get("scans", "scans")
    if not (study.get("embedded") and folder and Path(folder).is_dir() and list_scans(folder)[0]):
        return
    own = Path(source).with_name("mine.yaml")
    first = f"make STUDY={own}" if own.is_file() else f"make new, then make STUDY={own}"
    _say(f"{source} has synthetic specimens beside your scans; your scans alone: {first}")


def _name_leftovers(results):
    """Name the specimens that have files here but are no longer in the study."""
    listed = results / "specimens.txt"
    if not listed.is_file():
        return
    datasets = [*results.glob("specimens/*.nc"), *results.glob("contact_maps/*.nc")]
    left = {path.stem for path in datasets} - set(listed.read_text(encoding="utf-8").split())
    if left:
        _say(
            f"{results} keeps files of {', '.join(sorted(left))}, which the study no longer has; "
            "remove those you do not need"
        )


def _name_page(results):
    """Print the address of the result page, if it belongs to the last results."""
    page, atlas = results / "index.html", results / "atlas.nc"
    if page.is_file() and atlas.is_file() and page.stat().st_mtime >= atlas.stat().st_mtime:
        with contextlib.suppress(BrokenPipeError):
            print(f"the results: {page.resolve().as_uri()}", flush=True)


def _say(line):
    print(line, file=sys.stderr)


if __name__ == "__main__":
    main()
