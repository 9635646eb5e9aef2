"""What `make` runs: Snakemake on a study, after all that can be known beforehand was looked at.

python workflow/run.py STUDY [--dry-run] [--profile NAME] [--drop] [--full] [--verbose] -- WORDS

WORDS are options and targets of Snakemake.

The study is read as plain data first: Snakemake itself runs Python that stands in a study which
says `__use_yte__: true`. A lock that a killed run left is taken away, that of a living run never.
Files that were damaged since they were made are set aside, so that Snakemake makes them again. Told
to end, it ends all jobs. The terminal gets a line a job; Snakemake's own words are in
.snakemake/log, or, with --verbose, in the terminal instead.
"""

import argparse
import contextlib
import io
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
# The code of this checkout, wherever its environment was installed from: it may have been moved.
sys.path.insert(0, str(ROOT / "src"))
sys.path.append(str(ROOT / "workflow/scripts"))
import _running
import warm
from _warm import ADDRESS
from cluster import left_in_queue
from terminal import Terminal, put

from fractalcontact.core import checksums
from fractalcontact.core.atomic import sweep
from fractalcontact.core.errors import InputError
from fractalcontact.study.documents import read_study, study_name

#: Seconds that another run is waited for, which may only be reading the workflow; and that jobs get
#: to end when they are told to.
WAIT, GRACE, CLUSTER_GRACE = 3, 20, 120
#: Seconds that are waited for the last words of jobs once Snakemake has ended.
LAST_WORDS = 2
#: Where Snakemake finds the logger that shows on the terminal what happens.
LOGGER = ROOT / "workflow/logger"
#: What a shell does not take as it is.
SPLITS = r"[\s'\"\\$`&;|<>()*?\[\]#!{}]"
#: Bytes free below which a study is not begun: the default one makes some 100 MB.
LEAST_ROOM = 50 * 2**20


def main():
    """Run the study of the command line; what is wrong with it is said in one sentence."""
    options, passed = _options()
    try:
        _require_plain_path()
        name = study_name(read_study(options.study), options.study)
        results = Path("results") / (f"{name}_full" if options.full else name)
        if options.dry_run:
            _name_damage(results)
            sys.exit(_run([*_command(options, name), "--dry-run", *passed], options, results))
        _require_room(results)
        guard, has_locks = _running.alone(WAIT)
        if guard is None:
            raise InputError(
                "another run is at work in this folder (or jobs that a killed one left, which end "
                "by themselves); wait for it, or end it first"
            )
        _require_empty_queue(options.profile)
        if has_locks:
            _unlock(_command(options, name), options)
            _clean(results)
        else:
            print(
                "this file system knows no locks: what a killed run may have left stays",
                file=sys.stderr,
            )
        _running.share(guard)
        status = _run([*_command(options, name), *passed], options, results)
        if status == 0:
            _name_leftovers(results)
            _name_page(results)
    except (InputError, OSError) as error:  # a result, the guard or a folder that cannot be used
        sys.exit(f"error: {error}")
    if status:
        print(
            "the study did not finish; what is done is kept, and 'make' goes on from there",
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
    parser.add_argument("--verbose", action="store_true", help="all that Snakemake says")
    own = sys.argv[1:]
    passed = own[own.index("--") + 1 :] if "--" in own else []
    return parser.parse_args(own[: own.index("--")] if "--" in own else own), passed


def _command(options, name):
    command = [sys.executable, "-m", "snakemake", "--configfile", str(options.study)]
    command += ["--workflow-profile", f"workflow/profiles/{options.profile}"]
    return command + (["--config", f"study={name}_full", "accuracy=full"] if options.full else [])


def _require_plain_path():
    """Snakemake puts the path of the interpreter into a shell as it is."""
    if re.search(SPLITS, sys.executable):
        raise InputError(
            f"{sys.executable}: Snakemake cannot start scripts from a folder whose name has spaces "
            "or quotes in it; move the checkout to one without (nothing is made again for that)"
        )


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


def _require_empty_queue(profile):
    """Jobs of a killed run that wait on a cluster would write beside those of this one."""
    if left := left_in_queue(f"workflow/profiles/{profile}"):
        raise InputError(
            f"jobs of a run that was killed are still in the cluster's queue ({', '.join(left)}); "
            f"wait until they have ended, or end them: scancel {' '.join(left)}"
        )


def _unlock(command, options):
    """Take away what a killed run left of Snakemake's lock: nothing lives here now."""
    locks = Path(".snakemake/locks")
    if locks.is_dir() and any(locks.iterdir()):
        # What is wrong with the study is said by the run itself.
        environment = _environment(options) | {"FRACTALCONTACT_ALONE": "1"}
        subprocess.run([*command, "--unlock"], env=environment, capture_output=True)


def _environment(options):
    """What the workflow is told: that results were looked at here, and whether some may go."""
    told = {"FRACTALCONTACT_CHECKED": "1"} | ({"FRACTALCONTACT_DROP": "1"} if options.drop else {})
    return os.environ | told


def _spoilt(results):
    """Files that are not any more as their jobs left them, or of which nothing says what they are.

    Yields
    ------
    path : pathlib.Path
    why : str
    """
    digests = checksums.Digests(".snakemake/fractalcontact-digests.json")
    checked = checksums.check(results, digests.of)
    digests.save()
    for path in checked.damaged:
        yield path, "damaged or replaced after it was made"
    for path in checked.unrecorded:
        yield path, "without a checksum"


def _clean(results):
    """Remove what is half written; set aside what must not be read."""
    for path in sweep(results):
        print(f"removed {path}, which a killed run left unfinished", file=sys.stderr)
    for path, why in list(_spoilt(results)):
        aside = checksums.set_aside(results, path)
        print(f"{path}: {why}; moved to {aside}, and made again if needed", file=sys.stderr)


def _name_damage(results):
    for path, why in _spoilt(results):
        print(f"{path}: {why}; a run sets it aside, and makes it again if needed", file=sys.stderr)


def _run(command, options, results):
    """Exit code of a command whose whole family of processes ends with this one."""
    signals, child = (signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGQUIT), None
    terminal = None if options.verbose else Terminal(results, dry_run=options.dry_run)
    listeners = []
    warmth = contextlib.ExitStack()
    try:
        for number in signals:
            signal.signal(number, _stop)
        environment = _environment(options)
        # Jobs of a cluster run elsewhere; only Linux is sure to fork what libraries have loaded.
        local = options.profile == "default" and sys.platform == "linux"
        if local and not options.dry_run:
            environment[ADDRESS] = warmth.enter_context(warm.started())
        if terminal is None:
            child = subprocess.Popen(command, env=environment, start_new_session=True)
        else:
            child, listeners = _start(command, environment, terminal)
        status = child.wait()
    except _Stopped as stopped:
        for number in signals:
            signal.signal(number, signal.SIG_IGN)
        if terminal is not None:
            terminal.mute()
        print("interrupted: jobs end, and 'make' goes on from there", file=sys.stderr)
        if child is not None:
            _end(child, cluster=options.profile != "default")
        sys.exit(128 + stopped.args[0])
    finally:
        warmth.close()
    for number in signals:
        signal.signal(number, signal.SIG_DFL)
    for listener in listeners:
        listener.join(LAST_WORDS)  # jobs that outlive Snakemake keep the pipe open
    if terminal is not None:
        terminal.finish(status)
    return status if status >= 0 else 128 - status


def _start(command, environment, terminal):
    """Snakemake and those who listen to it: events of its logger, and what jobs write to stderr."""
    heard, told = os.pipe()
    path = os.pathsep.join(filter(None, [str(LOGGER), os.environ.get("PYTHONPATH")]))
    environment = environment | {"PYTHONPATH": path, "FRACTALCONTACT_EVENTS": str(told)}
    child = subprocess.Popen(
        [*command[:3], "--logger", "fractalcontact", *command[3:]],
        env=environment,
        pass_fds=(told,),
        stderr=subprocess.PIPE,
        start_new_session=True,
    )
    os.close(told)
    events = os.fdopen(heard, encoding="utf-8", errors="replace")
    words = io.TextIOWrapper(child.stderr, encoding="utf-8", errors="replace")
    listeners = [
        threading.Thread(
            target=_listen, args=(events, lambda line: terminal.hear(json.loads(line)))
        ),
        threading.Thread(target=_listen, args=(words, terminal.overhear)),
    ]
    for listener in listeners:
        listener.daemon = True
        listener.start()
    return child, listeners


def _listen(stream, take):
    with stream:
        for line in stream:
            take(line)


class _Stopped(Exception):
    """This process was told to end, by the signal of this number."""


def _stop(number, frame):
    raise _Stopped(number)


def _end(child, *, cluster):
    """Tell all processes of the run to end; those that do not are ended.

    Jobs on a cluster are taken back by Snakemake alone, and only where it is interrupted.
    """
    deadline = time.monotonic() + (CLUSTER_GRACE if cluster else GRACE)
    if cluster:
        child.send_signal(signal.SIGINT)
        left = True
    else:
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


def _name_page(results):
    """The last line of a run: where the results can be looked at, if these are the last ones."""
    page, atlas = results / "index.html", results / "atlas.nc"
    if page.is_file() and atlas.is_file() and page.stat().st_mtime >= atlas.stat().st_mtime:
        put(f"the results: {page.resolve().as_uri()}\n", sys.stdout)


if __name__ == "__main__":
    main()
