"""Faults in the middle of a job that stands still meanwhile, here or on a real SLURM.

What happens when is certain then: nothing hangs on how long a job takes. After each fault the study
is made until it is done, and compared with one that was made undisturbed, here and without SLURM.
"""

import contextlib
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from places import ROOT
from projects import copy_project, made, rough_heights, small_study, write_scan
from slurm_node import Node, missing

from fractalcontact.core.checksums import check

STUDY, ATLAS = "config/test.yaml", "results/test/atlas.nc"
#: Seconds until a job has begun, or a run has ended, on a busy machine too.
PATIENCE = 900
#: Every way in which a file is damaged.
DAMAGES = {
    "truncated": lambda content: content[: len(content) // 2],
    "empty": lambda content: b"",
    "flipped": lambda content: (
        content[: len(content) // 2]
        + bytes([content[len(content) // 2] ^ 1])
        + content[len(content) // 2 + 1 :]
    ),
    "text": lambda content: b"<html>404 not found</html>\n",
}
#: Faults by name, those of SLURM alone last.
HERE = (
    "damage kept",
    "damage meanwhile",
    "scan replaced",
    "scan removed",
    "full disk",
    "read-only",
)
SLURM = ("scan queued", "scan added", "memory", "time", "daemon", "node lost", "killed", "stopped")


class Skipped(Exception):
    """A fault that cannot be tried on this machine."""


def spoil(path, how):
    """Damage a file, and keep its times."""
    times = path.stat()
    path.write_bytes(DAMAGES[how](path.read_bytes()))
    os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))


class HeldStudy:
    """A small study of one scan, and runs of it that are caught in mid-work.

    Parameters
    ----------
    folder : path-like
    node : slurm_node.Node, optional
        The SLURM it runs on; without one it runs here.
    """

    def __init__(self, folder, node=None):
        self.node = node
        self.project = copy_project(Path(folder).resolve())
        self.results, self.orders = self.project / "results/test", self.project / "orders"
        self.orders.mkdir()
        small_study(self.project)
        self.scan = self.project / "scans/rock.npy"
        write_scan(self.project, "rock", rough_heights(n=64))
        engine = self.project / "workflow/engine"
        shutil.copy(ROOT / "tests/support/held_job.py", engine)
        begun, text = "    found_before = ", (engine / "job.py").read_text(encoding="utf-8")
        assert text.count(begun) == 1
        held = f"    from engine.held_job import hold\n\n    hold(snakemake.log[0])\n{begun}"
        (engine / "job.py").write_text(text.replace(begun, held), encoding="utf-8")
        self.reference = self._undisturbed()
        self.notes = []

    def _undisturbed(self):
        """Atlas and checksums of the study, made here from nothing."""
        shutil.rmtree(self.results, ignore_errors=True)
        done = made(self.project, STUDY, targets=[ATLAS])
        if done.returncode:
            raise SystemExit(done.stderr[-3000:])
        return self.found()

    def found(self):
        """The atlas, and the checksums of everything."""
        manifest = self.results / "manifest.sha256"
        return (self.project / ATLAS).read_bytes(), manifest.read_text(encoding="utf-8")

    def fault(self, name):
        """One fault, from a study with no results to the comparison.

        Returns
        -------
        outcome : str
            `same`, `refused, then same` or `WRONG`.
        notes : list of str
            What was done and seen.
        """
        self.notes, self._asked = [], {}
        self._before = {job.number for job in self.node.jobs()} if self.node else set()
        for order in self.orders.iterdir():
            order.unlink()
        if name != "full disk":
            shutil.rmtree(self.project / "results", ignore_errors=True)
        return getattr(self, name.replace(" ", "_").replace("-", "_"))(), self.notes

    # -- runs --------------------------------------------------------------------------------------

    def start(self):
        """What `make`, or `make slurm`, runs."""
        words = (
            ("--profile", "slurm", "--", "--slurm-init-seconds-before-status-checks", "1", "--")
            if self.node
            else ("--", "--cores", "2")
        )
        told = {"HELD_JOBS": str(self.orders)}
        self.said = self.project / "said.txt"
        with open(self.said, "w", encoding="utf-8") as said:
            return subprocess.Popen(
                (sys.executable, "workflow/run.py", STUDY, *words, ATLAS),
                cwd=self.project,
                stdout=said,
                stderr=said,
                env=os.environ | told,
            )

    def told(self):
        """What the last run said."""
        return self.said.read_text(encoding="utf-8")

    @contextlib.contextmanager
    def held(self, rule):
        """A run in which the job of a rule stands still."""
        self.order(rule, "hold")
        running = self.start()
        try:
            begun = self.orders / f"{rule}.begun"
            self.wait(lambda: begun.exists() or running.poll() is not None)
            if not begun.exists():
                raise RuntimeError(f"{rule} never began: {self.told()[-2000:]}")
            yield running
        finally:
            self.release(rule)
            if running.poll() is None:
                running.terminate()
            running.wait(PATIENCE)

    def order(self, rule, text):
        """Tell the next job of a rule what to do; it reads the whole order or none."""
        (self.orders / "written").write_text(text, encoding="utf-8")
        os.replace(self.orders / "written", self.orders / rule)

    def release(self, rule):
        (self.orders / rule).unlink(missing_ok=True)

    @staticmethod
    def wait(answers):
        until = time.monotonic() + PATIENCE
        while not answers():
            if time.monotonic() > until:
                raise RuntimeError(f"nothing happened in {PATIENCE} s")
            time.sleep(0.1)

    def verdict(self, running=None, refusals=1):
        """What became of a run, and of the same command given again after a refusal."""
        running = running or self.start()
        code = running.wait(PATIENCE)
        if code == 0:
            return "same" if self.is_same() else "WRONG"
        sentences = [line for line in self.told().splitlines() if "error: " in line]
        self.notes.append(f"refused: {sentences[0] if sentences else self.told()[-500:]}")
        if not sentences or not refusals or self.verdict(refusals=refusals - 1) == "WRONG":
            return "WRONG"
        return "refused, then same"

    def is_same(self):
        """Whether the atlas, and all else, has the bits of the study made undisturbed."""
        return self.found() == self.reference and not check(self.results).damaged

    # -- faults here and on SLURM ------------------------------------------------------------------

    def damage_kept(self):
        """Four files of a finished study, each damaged in its own way, their times kept."""
        self.verdict()
        names = ("specimens/rock.nc", "contact/rock/0.0.0.nc", "strength/rock.nc", "atlas.nc")
        for name, how in zip(names, DAMAGES, strict=True):
            spoil(self.results / name, how)
            self.notes.append(f"{name}: {how}")
        return self.verdict(refusals=0)

    def damage_meanwhile(self):
        """A file damaged, its time kept, just before the job that reads it."""
        with self.held("contact") as running:
            spoil(self.results / "joints/rock.nc", "flipped")
            self.notes.append("joints/rock.nc: flipped while the job that reads it began")
            self.release("contact")
            return self.verdict(running)

    def scan_replaced(self):
        """The scan replaced, its times kept, while its job runs; then put back."""
        with self.held("roughness_and_composite") as running:
            content = self._replace_scan()
            self.release("roughness_and_composite")
            running.wait(PATIENCE)
            self.scan.write_bytes(content)
            return self.verdict(running)

    def _replace_scan(self):
        """Another scan in the place of the first, whose content is given back, with its times."""
        content, times = self.scan.read_bytes(), self.scan.stat()
        write_scan(self.project, "rock", rough_heights(seed=5, n=64))
        os.utime(self.scan, ns=(times.st_atime_ns, times.st_mtime_ns))
        self.notes.append("scans/rock.npy: replaced, time kept")
        return content

    def scan_removed(self):
        """The scan removed while its job runs; then put back."""
        with self.held("roughness_and_composite") as running:
            aside = self.scan.rename(self.project / "aside.npy")
            self.notes.append("scans/rock.npy: removed")
            self.release("roughness_and_composite")
            running.wait(PATIENCE)
            aside.rename(self.scan)
            return self.verdict(running)

    def full_disk(self):
        """The disk of the results full while a job works; then there is room again."""
        if os.geteuid():
            raise Skipped("only root mounts a small disk")
        place = self.project / "results"
        shutil.rmtree(place, ignore_errors=True)
        place.mkdir()
        mount = ["mount", "-t", "tmpfs", "-o", "size=80m", "tmpfs", place]
        mounted = subprocess.run(mount, capture_output=True, text=True, encoding="utf-8")
        if mounted.returncode:
            raise Skipped(f"no tmpfs can be mounted: {mounted.stderr.strip()}")
        try:
            with self.held("contact") as running:
                filler = place / "filler"
                with contextlib.suppress(OSError), open(filler, "wb") as file:
                    while True:
                        file.write(b"x" * 4096)
                self.notes.append(f"{shutil.disk_usage(place).free} bytes free")
                self.release("contact")
                running.wait(PATIENCE)
                filler.unlink()
                return self.verdict(running)
        finally:
            subprocess.run(["umount", "-l", place], check=True)

    def read_only(self):
        """The folders of the results can no more be written to; then again.

        Root is bound by the attribute of immutable folders alone, and others by that too.
        """
        with self.held("contact") as running:
            folders = [p for p in [self.results, *self.results.rglob("*")] if p.is_dir()]
            if not _allow(folders, allowed=False):
                raise Skipped("this file system has no immutable folders (chattr +i), or no root")
            try:
                self.notes.append(f"{len(folders)} folders of results: chattr +i")
                self.release("contact")
                running.wait(PATIENCE)
            finally:
                _allow(folders, allowed=True)
            return self.verdict(running)

    # -- faults of SLURM ---------------------------------------------------------------------------

    def scan_queued(self):
        """The scan replaced while its job waits, which reads the study only when it begins."""
        with self.node.drained():
            running = self.start()
            self.wait(self.node.queue)
            content = self._replace_scan()
            self.notes.append(f"in the queue: {self._left()}")
        running.wait(PATIENCE)
        self.scan.write_bytes(content)
        return self.verdict(running)

    def scan_added(self):
        """A scan that comes while jobs wait: of the next run, whose atlas nobody compares here."""
        files = [self.scan.with_name(f"new{ending}") for ending in (".npy", ".yaml")]
        try:
            with self.node.drained():
                running = self.start()
                self.wait(self.node.queue)
                write_scan(self.project, "new", rough_heights(seed=5, n=64))
                self.notes.append(f"scans/new.npy: added; in the queue: {self._left()}")
            return self.verdict(running, refusals=0)
        finally:
            for path in files:
                path.unlink(missing_ok=True)

    def memory(self):
        """A job that takes what it asked for and more: SLURM ends it, the second may have twice."""
        with self.held("contact") as running:
            (first,) = self.jobs("contact")
            self.order("contact", f"memory {first.megabytes}")
            outcome = self.verdict(running, refusals=0)
        return self._grown("megabytes", outcome)

    def time(self):
        """A job whose time is over: SLURM ends it, the second has twice the time."""
        with self.held("contact") as running:
            (first,) = self.jobs("contact")
            self._asked = {first.number: first}
            self.node.let_time_be_over(first.number)
            self.wait(lambda: self.jobs("contact")[0].state == "TIMEOUT")
            self.release("contact")
            outcome = self.verdict(running, refusals=0)
        return self._grown("minutes", outcome)

    def daemon(self):
        """The node's daemon killed while it has a job, and started again."""
        with self.held("contact") as running:
            self.node.restart_slurmd(seconds=5)
            self.notes.append("slurmd: killed (-9), started again 5 s later, its job went on")
            self.release("contact")
            return self.verdict(running, refusals=0)

    def node_lost(self):
        """All of the node killed with its job, as by a loss of power, and started again."""
        with self.held("contact") as running:
            numbers = self.node.end_steps(self.project)
            # Only when the node is missed are its jobs given up.
            self.wait(lambda: not any(job.state == "RUNNING" for job in self.node.jobs()))
            self.node.restart_slurmd(seconds=1)
            self.notes.append(
                f"slurmd, its steps and {len(numbers)} processes of jobs: killed (-9)"
            )
            self.release("contact")
            return self.verdict(running, refusals=0)

    def killed(self):
        """Snakemake killed (-9) while jobs run and wait; the same command at once, and later."""
        with self.held("contact") as running:
            family = os.getpgid(_children(running.pid)[0])
            running.kill()
            os.killpg(family, signal.SIGKILL)
            self.notes.append(f"run.py and Snakemake: killed (-9); jobs left: {self._left()}")
            running.wait(PATIENCE)
            again = self.start()
            if again.wait(PATIENCE) == 0:
                return "WRONG"  # it must not work beside jobs of the killed run
            self.notes += [line for line in self.told().splitlines() if "error: " in line]
            self.release("contact")
            self.wait(lambda: not self.node.queue())
        before = {job.number for job in self.node.jobs()}
        outcome = self.verdict(refusals=0)
        after = [job.rule for job in self.node.jobs() if job.number not in before]
        self.notes.append(f"jobs of the next run: {', '.join(after)}")
        return "refused, then same" if outcome == "same" else outcome

    def stopped(self):
        """`make slurm` told to end (SIGTERM): no job stays in the queue."""
        with self.held("contact") as running:
            running.terminate()
            running.wait(PATIENCE)
            self.wait(lambda: not self.node.queue())
            self.notes.append("SIGTERM; the queue is empty, nothing works any more")
        return self.verdict(refusals=0)

    def jobs(self, rule):
        """Jobs of a rule that SLURM has had since the fault began."""
        return [job for job in self.node.jobs(rule) if job.number not in self._before]

    def _left(self):
        return ", ".join(f"{job.rule} {job.state}" for job in self.node.jobs() if job.is_left)

    def _grown(self, what, outcome):
        """The outcome, if a first job was ended and a second, which asked for twice, was not."""
        jobs = self.jobs("contact")
        asked = [getattr(self._asked.get(job.number, job), what) for job in jobs]
        for job, amount in zip(jobs, asked, strict=True):
            self.notes.append(f"{job.rule} asked for {amount} {what}: {job.state}")
        done = [job.state == "COMPLETED" for job in jobs]
        grown = done == [False, True] and asked[1] == 2 * asked[0]
        return outcome if grown else "WRONG"


def replay(names, accounting=False):
    """Faults through a real SLURM of one node, started for them; 1 if anything was wrong."""
    if reason := missing(accounting):
        sys.exit(f"error: {reason}")
    names = names or [*HERE, *SLURM]
    # Told to end, it ends its daemons too, and puts back what stood in /etc/slurm.
    signal.signal(signal.SIGTERM, lambda number, frame: sys.exit(128 + number))
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        places = [Path(folder).resolve() / name for name in ("study", "node")]
        for place in places:
            place.mkdir()
        node = Node(places[1], accounting=accounting)
        try:
            study = HeldStudy(places[0], node.start())
            for name in names:
                begin = time.monotonic()
                try:
                    outcome, notes = study.fault(name)
                except Skipped as reason:
                    outcome, notes = f"skipped: {reason}", []
                wrong += outcome == "WRONG"
                print(f"{name:18s}{outcome:20s}{time.monotonic() - begin:6.0f} s", flush=True)
                print("".join(f"    {note}\n" for note in notes), end="", flush=True)
        finally:
            node.stop()
            left = node.left()
    print(f"silently wrong: {wrong}; daemons left: {len(left)}")
    return int(wrong + len(left) > 0)


def _children(number):
    """Process ids of the children of a process."""
    path = Path(f"/proc/{number}/task/{number}/children")
    return [int(word) for word in path.read_text(encoding="utf-8").split()]


def _allow(folders, *, allowed):
    """Let folders be changed or not; whether that could be said."""
    command = ["chattr", "-i" if allowed else "+i", *folders]
    try:
        done = subprocess.run(command, capture_output=True)
    except FileNotFoundError:
        return False
    if done.returncode and not allowed:
        subprocess.run(["chattr", "-i", *folders], capture_output=True)
    return done.returncode == 0
