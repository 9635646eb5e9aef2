"""Faults replayed on a small study: whatever happens, no result is wrong without a word.

    make faults                     all of it, some 40 minutes on two cores
    make faults FAULTS=--quick      a few of each, some minutes
    make faults FAULTS='--only kills damage --seed 3'
    make faults FAULTS=--slurm      jobs caught in mid-work on a real SLURM (root on Debian)

Each fault ends in one of four ways: the results are the same to the last bit as those of an
undisturbed run (`same`); the fault was refused in a sentence, after which the same command gives
them (`refused, then same`); it cannot be tried here, with the reason (`skipped`); or they are
something else (`WRONG`), of which there must be none.
"""

import argparse
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "tests/support"), str(ROOT / "src")]
from ensembles import ENSEMBLES
from held_faults import HERE, SLURM, HeldStudy, Skipped, replay
from projects import copy_project, made, rough_heights, small_study, write_scan

from fractalcontact.core.checksums import check

#: Kinds of faults; how many of each stands in tests/support/ensembles.py.
FAULTS = (
    "kills",
    "damage",
    "noticed",
    "scans",
    "scans meanwhile",
    "scans ahead",
    "stops",
    "full disks",
    "two runs",
    "threads",
    "forks",
    "interrupts",
    "kernels",
    "held",
)
DAMAGES = {
    "truncate": lambda content, chance: content[: chance.randrange(max(len(content), 1))],
    "empty": lambda content, chance: b"",
    "flip": lambda content, chance: _flipped(content, chance),
    "text": lambda content, chance: b"<html>404 not found</html>\n",
}
STUDY = "config/test.yaml"
#: Seconds after which a process of the library counts as hung. Compiling all kernels again takes
#: minutes, on a busy machine many.
PATIENCE = 3600
#: All stages and the figures of the study; those of specimens take longest, and are no other kind.
TARGETS = ("results/test/atlas.nc", "results/test/figures/area_slope.png")
#: A solve, often: on one space in threads, after forks, after interrupts.
SOLVER = """
import hashlib, multiprocessing, os, signal, sys, threading
from concurrent.futures import ThreadPoolExecutor
import numpy as np
from fractalcontact import HalfSpace, solve_contact
from fractalcontact.surface.synthesis import self_affine
sizes = (48, 200, 400)
surfaces = {n: self_affine((n, n), 1.0, 0.8, seed=n, rms=1.0) for n in sizes}
spaces = {n: HalfSpace((n, n), (1.0, 1.0), 1.0) for n in sizes}
def solve(n, k):
    state = solve_contact(surfaces[n], spaces[n], force=(1 + k) * 0.01 * n**2)
    return hashlib.sha256(state.pressure.tobytes()).hexdigest()
cases = [(n, k) for k in range(4) for n in sizes]
"""


def _flipped(content, chance):
    at = chance.randrange(len(content))
    return content[:at] + bytes([content[at] ^ (1 << chance.randrange(8))]) + content[at + 1 :]


class Trials:
    """A study that was made undisturbed, and trials of it."""

    def __init__(self, folder, seed):
        self.project, self.chance = copy_project(folder), random.Random(seed)
        self.results = self.project / "results/test"
        # One scan that slides, one surface of the study's own: every kind of file, in seconds.
        recipe = {"size": "6.4 mm", "spacing": "0.1 mm", "dimension": 2.2, "rms": "0.1 mm"}
        small_study(
            self.project,
            embedded={"own": {"label": "own surface", "seed": 1, **recipe}},
            specimens={"own": {"opposite": "flat"}},
            area_slope={
                **{"dimension": 2.2, "nodes": 64, "seeds": [1, 2]},
                **{"roll_off_share": 0.25, "loads": [0.01, 0.02]},
            },
        )
        self.scan = self.project / "scans/rock.npy"
        write_scan(self.project, "rock", rough_heights(n=64))
        self.targets = TARGETS
        self.references = {self.scan.read_bytes(): self._undisturbed()}
        # By name, as the whole study does it: what is missing of them is made again.
        self.targets = [f"results/test/{line[66:]}" for line in self.found().splitlines()]

    def _undisturbed(self):
        done = self.make()
        if done.returncode:
            raise SystemExit(done.stderr[-3000:])
        return self.found()

    def found(self):
        """Checksums of all results there are, in the manifest's form."""
        return (self.results / "manifest.sha256").read_text()

    def make(self):
        return made(self.project, STUDY, targets=self.targets)

    def verdict(self, *, refusals=1):
        """Whether a run, or one after a refusal in a sentence, gives what an undisturbed did."""
        for refused in range(refusals + 1):
            done = self.make()
            if done.returncode == 0:
                intact = not check(self.results).damaged
                same = self.found() == self.references[self.scan.read_bytes()] and intact
                return ("refused, then same" if refused else "same") if same else "WRONG"
            if not any(line.startswith("error: ") for line in done.stderr.splitlines()):
                return "WRONG"
        return "WRONG"

    def start(self):
        return subprocess.Popen(
            (sys.executable, "workflow/run.py", STUDY, "--", "--cores", "2", *self.targets),
            cwd=self.project,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
        )

    def at_work(self):
        """Numbers of all processes that work in the project."""
        found = []
        for entry in filter(str.isdigit, os.listdir("/proc")):
            try:
                if Path(os.readlink(f"/proc/{entry}/cwd")) == self.project:
                    found.append(int(entry))
            except OSError:  # it has ended, or is another user's
                continue
        return [number for number in found if number != os.getpid()]

    # -- faults: each a generator of outcomes ------------------------------------------------------

    def kills(self, times):
        """Everything killed at a random moment, again and again, until a run gets through."""
        for _ in range(times):
            if self.chance.random() < 0.5:
                shutil.rmtree(self.results, ignore_errors=True)
            running = self.start()
            end = time.monotonic() + self.chance.uniform(0.5, 10)
            while running.poll() is None and time.monotonic() < end:
                time.sleep(0.01)
            while left := self.at_work():
                for number in left:
                    try:
                        os.kill(number, signal.SIGKILL)
                    except ProcessLookupError:
                        continue
                time.sleep(0.02)
            running.communicate()
            yield self.verdict(refusals=0)

    def noticed(self, times):
        """Every kind of file, damaged in every way with its time kept or not: is it seen."""
        for path in self.kinds():
            for how in DAMAGES:
                for keep in (False, True):
                    before = path.read_bytes()
                    self.damage(path, how, keep)
                    yield "same" if path in check(self.results).damaged else "WRONG"
                    path.write_bytes(before)

    def damage(self, path, how, keep_times):
        content, times = path.read_bytes(), path.stat()
        spoilt = content
        while spoilt == content:
            spoilt = DAMAGES[how](content, self.chance)
        path.write_bytes(spoilt)
        if keep_times:
            os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))

    def kinds(self):
        """A file of every kind that jobs make; an empty one cannot be truncated."""
        found = {}
        for line in self.found().splitlines():
            name = Path(line[66:])
            if not (self.results / name).stat().st_size:
                continue
            kind = (name.parts[0], name.suffix, len(name.parts))
            found.setdefault(kind, []).append(self.results / name)
        return [self.chance.choice(paths) for _, paths in sorted(found.items())]

    def damaged(self, times):
        """Damaged files are made again by the next run, one kind alone or all kinds at once."""
        kinds = self.kinds()
        ways = [(how, keep) for how in DAMAGES for keep in (False, True)]
        trials = [([path], *self.chance.choice(ways)) for path in kinds]
        trials += [(kinds, *way) for way in ways]
        if times:
            trials = self.chance.sample(trials, times)
        for paths, how, keep in trials:
            for path in paths:
                self.damage(path, how, keep)
            yield self.verdict(refusals=0)

    def scans(self, times):
        """A scan replaced by another, and put back, with older, equal and newer times."""
        self.know_another_scan()
        for _ in range(times):
            self.replace(self.another_scan(), self.chance.choice([-1e8, -3600, 0]))
            yield self.verdict(refusals=0)

    def scans_ahead(self, times):
        """The same from a machine whose clock runs ahead: refused until it is dated today."""
        self.know_another_scan()
        for _ in range(times):
            self.replace(self.another_scan(), time.time() - self.scan.stat().st_mtime + 3600)
            refused = self.make()
            os.utime(self.scan)
            said = "ahead of this machine's clock" in refused.stderr and refused.returncode
            same = self.verdict(refusals=0) == "same"
            yield "refused, then same" if said and same else "WRONG"

    def know_another_scan(self):
        """What an undisturbed run makes of a second scan."""
        if len(self.references) == 1:
            np.save(self.project / "other.npy", rough_heights(seed=5, n=64))
            self.replace((self.project / "other.npy").read_bytes(), 0)
            shutil.rmtree(self.results)
            self.references[self.scan.read_bytes()] = self._undisturbed()

    def another_scan(self):
        now = self.scan.read_bytes()
        return next(content for content in self.references if content != now)

    def replace(self, content, age):
        """Another file in the scan's place, this many seconds younger."""
        times, other = self.scan.stat(), self.project / "other.npy"
        other.write_bytes(content)
        when = times.st_mtime_ns + int(age * 1e9)
        os.utime(other, ns=(when, when))
        os.replace(other, self.scan)

    def scans_meanwhile(self, times):
        """The same while the study runs, at a random moment."""
        self.know_another_scan()
        for _ in range(times):
            shutil.rmtree(self.results, ignore_errors=True)
            running = self.start()
            time.sleep(self.chance.uniform(2, 9))
            self.replace(self.another_scan(), -1e8)
            running.communicate()
            yield self.verdict()

    def stops(self, times):
        """`make` told to end: nothing goes on working, and the next run goes on."""
        for k in range(times):
            shutil.rmtree(self.results, ignore_errors=True)
            running = self.start()
            time.sleep(self.chance.uniform(1, 10))
            running.send_signal((signal.SIGTERM, signal.SIGINT, signal.SIGHUP)[k % 3])
            running.communicate()
            time.sleep(0.5)
            yield "WRONG" if self.at_work() else self.verdict(refusals=0)

    def full_disks(self, times):
        """The disk of the results full after this many bytes; then there is room again."""
        if os.geteuid():
            raise Skipped("only root mounts a small disk")
        shutil.rmtree(self.project / "results")
        for _ in range(times):
            (self.project / "results").mkdir(exist_ok=True)
            mount = ["mount", "-t", "tmpfs", "-o", "size=80m", "tmpfs", self.project / "results"]
            mounted = subprocess.run(mount, capture_output=True, text=True)
            if mounted.returncode:
                raise Skipped(f"no tmpfs can be mounted: {mounted.stderr.strip()}")
            try:
                filler = self.project / "results/filler"
                left = int(2 ** self.chance.uniform(14, 22))
                running = self.start()
                time.sleep(1.5)  # by then it has seen that there is room
                filler.write_bytes(b"x" * (80 * 2**20 - left))
                said = running.communicate()[1]
                sentence = "no space left" in said or "No space left" in said
                filler.unlink()
                outcome = self.verdict(refusals=0)
                ended = running.returncode == 0 or sentence
                yield (
                    outcome
                    if ended and outcome == "WRONG"
                    else ("refused, then same" if ended and running.returncode else outcome)
                )
            finally:
                subprocess.run(["umount", "-l", self.project / "results"], check=True)
        self.make()

    def held(self, times):
        """Faults in the middle of a job that stands still meanwhile."""
        folder = self.project.with_name("held")
        folder.mkdir(exist_ok=True)
        study = HeldStudy(folder)
        for name in HERE[:times]:
            yield study.fault(name)[0]

    def two_runs(self, times):
        """A second run beside a living one is refused, and the first is not disturbed."""
        for _ in range(times):
            shutil.rmtree(self.results, ignore_errors=True)
            running = self.start()
            time.sleep(self.chance.uniform(0.5, 6))
            second = self.make()
            first_said = running.communicate()[1]
            # Whichever came first has finished; the other was refused, unless it came after that.
            said = {running.returncode: first_said, second.returncode: second.stderr}
            refused = "another run is at work" in said.get(1, "another run is at work")
            yield self.verdict(refusals=0) if 0 in said and refused else "WRONG"

    # -- faults of the library: a process each -----------------------------------------------------

    def library(self, code, **environment):
        """`same` if the code says so."""
        environment = os.environ | {"PYTHONPATH": str(ROOT / "src")} | environment
        command = [sys.executable, "-c", SOLVER + code]
        try:
            done = subprocess.run(
                command, capture_output=True, text=True, timeout=PATIENCE, env=environment
            )
        except subprocess.TimeoutExpired:
            return "WRONG"
        return "same" if done.returncode == 0 and done.stdout == "same\n" else "WRONG"

    def threads(self, times):
        """Eight threads on one space."""
        for _ in range(times):
            yield self.library(
                "alone = [solve(*case) for case in cases]\n"
                "with ThreadPoolExecutor(8) as pool:\n"
                "    found = list(pool.map(lambda case: solve(*case), cases * 2))\n"
                "print('same' if found == alone * 2 else 'other')\n"
            )

    def forks(self, times):
        """A fork after a solve that used threads, also while another thread solves."""
        for _ in range(times):
            yield self.library(
                "alone = [solve(*case) for case in cases]\n"
                "busy = threading.Thread(target=lambda: [solve(*case) for case in cases * 2])\n"
                "busy.start()\n"
                "with multiprocessing.get_context('fork').Pool(3) as pool:\n"
                "    found = pool.starmap(solve, cases)\n"
                "busy.join()\n"
                "print('same' if found == alone else 'other')\n"
            )

    def interrupts(self, times):
        """Solves interrupted at random moments; those after them have the same bits."""
        outcome = self.library(
            "import random, time\n"
            f"chance, wrong = random.Random({self.chance.randrange(10**6)}), 0\n"
            "alone = [solve(*case) for case in cases]\n"
            "class Stop(Exception): pass\n"
            "def stop(number, frame): raise Stop\n"
            "signal.signal(signal.SIGALRM, stop)\n"
            f"for _ in range({times}):\n"
            "    k = chance.randrange(len(cases))\n"
            "    try:\n"
            "        signal.setitimer(signal.ITIMER_REAL, chance.uniform(1e-4, 0.08))\n"
            "        solve(*cases[k])\n"
            "    except (Stop, SystemError):\n"  # the second from inside a compiled kernel
            "        pass\n"
            "    finally:\n"
            "        signal.setitimer(signal.ITIMER_REAL, 0)\n"
            "    wrong += solve(*cases[k]) != alone[k]\n"
            "print('other' if wrong else 'same')\n"
        )
        yield from [outcome] * times

    def kernels(self, times):
        """Compiled kernels damaged on disk are compiled again."""
        check_all = "print('same' if [solve(*case) for case in cases] == {} else 'other')\n"
        with tempfile.TemporaryDirectory() as cache:
            seen = subprocess.run(
                [sys.executable, "-c", SOLVER + "print([solve(*case) for case in cases])"],
                capture_output=True,
                text=True,
                check=True,
                env=os.environ | {"PYTHONPATH": str(ROOT / "src"), "NUMBA_CACHE_DIR": cache},
            ).stdout.strip()
            for k in range(times):
                kept = sorted(path for path in Path(cache).rglob("*") if path.is_file())
                for path in self.chance.sample(kept, min(5, len(kept))):
                    if path.stat().st_size:
                        self.damage(path, list(DAMAGES)[k % len(DAMAGES)], k % 2 == 0)
                yield self.library(check_all.format(seen), NUMBA_CACHE_DIR=cache)


def main():
    """Replay faults and print what became of them; 1 if anything was wrong."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--quick", action="store_true", help="a few of each")
    parser.add_argument("--only", nargs="+", help="these faults alone")
    parser.add_argument("--slurm", action="store_true", help="held ones on a SLURM of one node")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    names = (*HERE, *SLURM) if options.slurm else FAULTS
    if unknown := set(options.only or ()) - set(names):
        parser.error(f"no fault {', '.join(unknown)}; there are {', '.join(names)}")
    if options.slurm:
        return replay(options.only)
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder).resolve() / "study"
        place.mkdir()
        trials = Trials(place, options.seed)
        faults = {
            "damage": trials.damaged,
            **{
                name: getattr(trials, name.replace(" ", "_")) for name in FAULTS if name != "damage"
            },
        }
        print(f"{'fault':18s}{'trials':>8s}{'same':>8s}{'refused, then same':>20s}{'WRONG':>8s}")
        for name in FAULTS:
            if options.only and name not in options.only:
                continue
            quick, full = ENSEMBLES.get(f"faults: {name}", (0, 0))
            begin = time.monotonic()
            outcomes, note = Counter(), ""
            try:
                outcomes.update(faults[name](quick if options.quick else full))
            except Skipped as reason:
                note = f"skipped: {reason}"
            wrong += outcomes["WRONG"]
            numbers = f"{outcomes['same']:8d}{outcomes['refused, then same']:20d}"
            print(
                f"{name:18s}{outcomes.total():8d}{numbers}{outcomes['WRONG']:8d}"
                f"   {time.monotonic() - begin:.0f} s {note}",
                flush=True,
            )
    print(f"silently wrong: {wrong}")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
