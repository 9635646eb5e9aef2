"""What `make` runs: Snakemake on a study, after all that can be known beforehand was looked at.

python workflow/run.py STUDY [--profile NAME] [--drop] [--full] [--dry-run] -- options and targets

The study is read as plain data first: Snakemake itself runs Python that stands in a study which
says `__use_yte__: true`. A lock that a killed run left is taken away, that of a living run never.
Files that were damaged since they were made are removed, so that Snakemake makes them again. Told
to end, it ends all jobs.
"""

import argparse
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
# The code of this checkout, wherever its environment was installed from: it may have been moved.
sys.path.insert(0, str(ROOT / "src"))
sys.path.append(str(ROOT / "workflow/scripts"))
import _running

from fractalcontact import checksums
from fractalcontact.atomic import atomic_write, sweep
from fractalcontact.errors import InputError, OutputError
from fractalcontact.study import read_study, study_name

#: Seconds that another run is waited for, which may only be reading the workflow; and that jobs get
#: to end when they are told to.
WAIT, GRACE = 3, 20
#: Bytes free below which a study is not begun: the default one makes some 100 MB.
LEAST_ROOM = 50 * 2**20


def main():
    """Run the study of the command line; what is wrong with it is said in one sentence."""
    options, passed = _options()
    try:
        name = study_name(read_study(options.study), options.study)
        results = Path("results") / (f"{name}_full" if options.full else name)
        if options.dry_run:
            sys.exit(_ended(subprocess.Popen([*_command(options, name), "--dry-run", *passed])))
        _require_room(results)
        guard = _running.alone(WAIT)
        if guard is None:
            raise InputError(
                "another run is at work in this folder (or jobs that a killed one left, which end "
                "by themselves); wait for it, or end it first"
            )
        _unlock(options)
        _clean(results)
        _running.share(guard)
        status = _run([*_command(options, name), *passed])
        if status == 0:
            _write_manifest(results)
            _name_leftovers(results)
    except (InputError, OutputError) as error:
        sys.exit(f"error: {error}")
    if status:
        print(
            "make: the study did not finish; what is done is kept, and 'make' goes on from there.",
            file=sys.stderr,
        )
    sys.exit(status)


def _options():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("study", type=Path)
    parser.add_argument("--profile", default="default", help="of workflow/profiles")
    parser.add_argument("--drop", action="store_true", help="the atlas may lose specimens")
    parser.add_argument("--full", action="store_true", help="at full cost, beside the study")
    parser.add_argument("--dry-run", action="store_true", help="say what would be done")
    own = sys.argv[1:]
    passed = own[own.index("--") + 1 :] if "--" in own else []
    return parser.parse_args(own[: own.index("--")] if "--" in own else own), passed


def _snakemake():
    return [sys.executable, "-m", "snakemake"]


def _command(options, name):
    command = [*_snakemake(), "--workflow-profile", f"workflow/profiles/{options.profile}"]
    command += ["--configfile", str(options.study)]
    changes = ["drop_specimens=true"] if options.drop else []
    if options.full:
        changes += [f"study={name}_full", "accuracy=full"]
    return command + (["--config", *changes] if changes else [])


def _require_room(results):
    """Say before minutes are spent that there is no place for what they would give."""
    folder = results
    while not folder.exists():
        folder = folder.parent
    if not folder.is_dir() or not os.access(folder, os.W_OK | os.X_OK):
        raise InputError(f"{folder}: no folder that can be written to; allow it (chmod u+w)")
    free = shutil.disk_usage(folder).free
    if free < LEAST_ROOM:
        raise InputError(
            f"{folder}: {free / 2**20:.0f} MB free on its disk, less than the "
            f"{LEAST_ROOM / 2**20:.0f} MB that a study needs at least; make room"
        )


def _unlock(options):
    """Take away what a killed run left of Snakemake's lock: nothing lives here now."""
    locks = Path(".snakemake/locks")
    if locks.is_dir() and any(locks.iterdir()):
        # What is wrong with the study is said by the run itself.
        command = [*_snakemake(), "--configfile", str(options.study), "--unlock", "--quiet", "all"]
        environment = os.environ | {"FRACTALCONTACT_ALONE": "1", "FRACTALCONTACT_CHECKED": "1"}
        subprocess.run(command, env=environment, capture_output=True)


def _clean(results):
    """Remove what is half written, and what is not any more as its job left it."""
    if not results.is_dir():
        return
    for path in sweep(results):
        print(f"removed {path}, which a killed run left unfinished", file=sys.stderr)
    digests = checksums.Digests(".snakemake/fractalcontact-digests.json")
    checked = checksums.check(results, digests.of)
    for path in checked.damaged:
        path.unlink(missing_ok=True)
        print(
            f"removed {path}: damaged or replaced after it was made; it is made again",
            file=sys.stderr,
        )
    digests.save()


def _run(command):
    """Exit code of a command whose whole family of processes ends with this one."""
    environment = os.environ | {"FRACTALCONTACT_CHECKED": "1"}
    signals, child = (signal.SIGTERM, signal.SIGINT, signal.SIGHUP), None
    try:
        for number in signals:
            signal.signal(number, _stop)
        child = subprocess.Popen(command, env=environment, start_new_session=True)
        return _ended(child)
    except _Stopped as stopped:
        for number in signals:
            signal.signal(number, signal.SIG_IGN)
        print("make: told to stop; jobs end, and 'make' goes on from there.", file=sys.stderr)
        if child is not None:
            _end(child)
        sys.exit(128 + stopped.args[0])


class _Stopped(Exception):
    """This process was told to end, by the signal of this number."""


def _stop(number, frame):
    raise _Stopped(number)


def _ended(child):
    status = child.wait()
    return status if status >= 0 else 128 - status


def _end(child):
    """Tell all processes of the run to end; those that do not are ended."""
    deadline = time.monotonic() + GRACE
    left = _tell(child, signal.SIGTERM)
    while left and time.monotonic() < deadline:
        time.sleep(0.05)
        child.poll()  # one that has ended counts until somebody has asked
        left = _tell(child, 0)
    if left:
        _tell(child, signal.SIGKILL)
    child.wait()


def _tell(child, number):
    """Send a signal to all processes of a run; whether there are any."""
    try:
        os.killpg(child.pid, number)
    except ProcessLookupError:
        return False
    return True


def _write_manifest(results):
    """All checksums in one file beside the atlas, as `sha256sum -c` takes them."""
    if results.is_dir():
        lines = checksums.lines_of(results)
        with atomic_write(results / "manifest.sha256") as path:
            path.write_text("".join(lines), encoding="utf-8")


def _name_leftovers(results):
    """Say which specimens have files here that the study does not know any more."""
    listed = results / "specimens.txt"
    if not listed.is_file():
        return
    names = listed.read_text(encoding="utf-8").split()
    left = {path.stem for path in results.glob("specimens/*.nc")} - set(names)
    left |= {path.stem for path in results.glob("contact_maps/*.nc")} - set(names)
    if left:
        print(
            f"{results} keeps files of {', '.join(sorted(left))}, which the study no longer has; "
            "remove those you do not need",
            file=sys.stderr,
        )


if __name__ == "__main__":
    main()
