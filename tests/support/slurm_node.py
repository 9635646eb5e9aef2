"""A real SLURM of one node on this machine: its daemons, its configuration, its end.

Only for tests, and only as root: the configuration has to stand in /etc/slurm, because a step of a
job drops the variable that would name another place. What stood there before is put back.
"""

import contextlib
import ctypes
import os
import pwd
import shutil
import signal
import socket
import subprocess
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

CONFIGURATION = Path("/etc/slurm")
PACKAGES = ("slurm-wlm", "munge")
ACCOUNTING_PACKAGES = ("slurmdbd", "mariadb-server")
PARTITION = "test"
PR_SET_PDEATHSIG = 1  # of <linux/prctl.h>
#: Seconds until a daemon answers.
PATIENCE = 60

SLURM_CONF = """\
# of the tests of fractalcontact
ClusterName=fractalcontact
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmdUser=root
SlurmdParameters=config_overrides
AuthType=auth/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/linux
JobAcctGatherFrequency=1
JobAcctGatherParams=OverMemoryKill
{accounting}
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
SchedulerType=sched/backfill
SchedulerParameters=batch_sched_delay=0,sched_interval=1,bf_interval=1,sched_min_interval=0
MinJobAge=600
ReturnToService=2
KillWait=5
SlurmdTimeout=20
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/log/slurmctld.log
SlurmdLogFile={folder}/log/slurmd.log
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} RealMemory={memory} State=UNKNOWN
PartitionName={partition} Nodes={host} Default=YES MaxTime=120 DefMemPerCPU=256 State=UP
"""
#: By what one that was killed left behind is known.
OURS = SLURM_CONF.splitlines()[0]
NO_ACCOUNTING = "AccountingStorageType=accounting_storage/none"
WITH_ACCOUNTING = """\
AccountingStorageType=accounting_storage/slurmdbd
AccountingStorageHost=127.0.0.1
AccountingStoreFlags=job_comment"""
SLURMDBD_CONF = """\
AuthType=auth/munge
DbdHost={host}
DbdAddr=127.0.0.1
SlurmUser=root
StorageType=accounting_storage/mysql
StorageHost=localhost
StorageUser=root
StorageLoc=fractalcontact_tests
PidFile={folder}/slurmdbd.pid
LogFile={folder}/log/slurmdbd.log
"""


def missing(accounting: bool = False) -> str:
    """Why no SLURM can be started here, in words; nothing if it can."""
    if os.geteuid() != 0:
        return "a SLURM is started by root alone (its daemons, /etc/slurm)"
    daemons = ["slurmctld", "slurmd", "munged"] + (["slurmdbd", "mariadbd"] if accounting else [])
    absent = [name for name in daemons if shutil.which(name) is None]
    if not absent:
        return ""
    packages = PACKAGES + (ACCOUNTING_PACKAGES if accounting else ())
    return f"no {', '.join(absent)}: apt-get install {' '.join(packages)}"


@dataclass(frozen=True)
class Job:
    """What SLURM says of a job: its rule, what it asked for, what became of it."""

    number: str
    rule: str
    state: str
    megabytes: int
    minutes: int

    @property
    def is_left(self):
        return self.state in ("PENDING", "CONFIGURING", "RUNNING", "COMPLETING")


class Node:
    """A SLURM of one node, from :meth:`start` to :meth:`stop`.

    Parameters
    ----------
    folder : path-like
        For its state, process ids and logs.
    cpus : int
        More than there are: they share what there is.
    accounting : bool
        With slurmdbd and a database, in ``folder`` too.
    """

    def __init__(self, folder, cpus=2, accounting=False):
        self.folder, self.cpus, self.accounting = Path(folder), cpus, accounting
        self.host = socket.gethostname().split(".")[0]
        self.daemons: list[subprocess.Popen] = []
        self.kept: Path | None = None
        self.configured = False
        self.before = _alive()
        self.database: Path | None = None

    def start(self):
        """Write the configuration and start all daemons, in the foreground, as children."""
        for name in ("state", "spool", "log"):
            (self.folder / name).mkdir(parents=True, exist_ok=True)
        # slurmd and munged look at who owns the folders above theirs.
        os.chmod(self.folder, 0o755)
        self._configure()
        self._start_munge()
        if self.accounting:
            self._start_accounting()
        self._run("slurmctld", "slurmctld", "-D", "-i")
        self.slurmd = self._run("slurmd", "slurmd", "-D", "-N", self.host)
        self._wait("the node", self.is_idle)
        return self

    def is_idle(self):
        """Whether the node says that it takes jobs."""
        found = subprocess.run(
            ["sinfo", "-h", "-o", "%T"], capture_output=True, text=True, encoding="utf-8"
        )
        return found.stdout.strip() in ("idle", "mixed", "allocated")

    def restart_slurmd(self, seconds=1.0):
        """Kill the daemon of the node, and start it again after a while."""
        if self.slurmd.poll() is None:
            os.killpg(self.slurmd.pid, signal.SIGKILL)
        self.slurmd.wait()
        self.daemons.remove(self.slurmd)
        time.sleep(seconds)
        self.slurmd = self._run("slurmd", "slurmd", "-D", "-N", self.host)
        self._wait("the node", self.is_idle)

    def queue(self):
        """Jobs that wait or run, a line each."""
        done = subprocess.run(["squeue", "-h"], capture_output=True, text=True, encoding="utf-8")
        return done.stdout.strip().splitlines()

    def jobs(self, rule=""):
        """All jobs that it knows, of one rule or of all, in the order in which they came."""
        command = ["squeue", "-h", "--states=all", "--sort=i", "--format=%i|%k|%T|%m|%l"]
        done = subprocess.run(command, capture_output=True, text=True, check=True, encoding="utf-8")
        lines = (line.split("|") for line in done.stdout.splitlines())
        jobs = (
            Job(
                number=number,
                rule=comment.removeprefix("rule_").partition("_wildcards_")[0],
                state=state,
                megabytes=_megabytes(memory),
                minutes=_minutes(limit),
            )
            for number, comment, state, memory, limit in lines
        )
        return [job for job in jobs if rule in ("", job.rule)]

    @contextlib.contextmanager
    def drained(self):
        """Jobs wait in the queue, and none begins."""
        _require("scontrol", "update", f"NodeName={self.host}", "State=DRAIN", "Reason=test")
        try:
            yield
        finally:
            _require("scontrol", "update", f"NodeName={self.host}", "State=RESUME")

    @staticmethod
    def let_time_be_over(number):
        """Let the time of a running job be over in a second: SLURM then ends it itself."""
        _require("scontrol", "update", f"JobId={number}", "EndTime=now+1")

    def end_steps(self, folder):
        """Kill all that a node does with its jobs in a folder, as a loss of power would.

        Returns
        -------
        list of int
            The processes.
        """
        os.killpg(self.slurmd.pid, signal.SIGKILL)
        numbers = [
            n for n in map(int, filter(str.isdigit, os.listdir("/proc"))) if _is_of(n, folder)
        ]
        for number in numbers:
            with contextlib.suppress(ProcessLookupError):
                os.kill(number, signal.SIGKILL)
        return numbers

    def stop(self):
        """End what was started, by process id, last first; put back what stood in /etc/slurm."""
        subprocess.run(["scancel", "--user", "root"], capture_output=True)
        for daemon in reversed(self.daemons):
            _end(daemon)
        self.daemons.clear()
        if self.database is not None:
            shutil.rmtree(self.database, ignore_errors=True)
        if self.configured:
            shutil.rmtree(CONFIGURATION, ignore_errors=True)
        if self.kept is not None:
            shutil.move(self.kept, CONFIGURATION)

    def left(self):
        """Processes of SLURM that live and did not before :meth:`start`: none after :meth:`stop`.

        What a daemon forked may take seconds longer to end than the daemon.

        Returns
        -------
        list of str
        """
        end = time.monotonic() + 10
        while (left := _alive() - self.before) and time.monotonic() < end:
            time.sleep(0.1)
        return sorted(left)

    def _configure(self):
        ours = CONFIGURATION / "slurm.conf"
        if ours.is_file() and ours.read_text(errors="replace", encoding="utf-8").startswith(OURS):
            shutil.rmtree(CONFIGURATION)
        elif CONFIGURATION.exists():
            self.kept = self.folder / "etc-slurm-before"
            shutil.move(CONFIGURATION, self.kept)
        self.configured = True
        CONFIGURATION.mkdir()
        pages = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
        words = {
            "host": self.host,
            "folder": self.folder,
            "cpus": self.cpus,
            "memory": int(pages / 2**20 * 0.9),
            "partition": PARTITION,
            "accounting": WITH_ACCOUNTING if self.accounting else NO_ACCOUNTING,
        }
        (CONFIGURATION / "slurm.conf").write_text(SLURM_CONF.format(**words), encoding="utf-8")
        if self.accounting:
            path = CONFIGURATION / "slurmdbd.conf"
            path.write_text(SLURMDBD_CONF.format(**words), encoding="utf-8")
            path.chmod(0o600)

    def _start_munge(self):
        """The daemon that vouches for who asks, unless one answers already."""
        if subprocess.run(["munge", "-n"], capture_output=True).returncode == 0:
            return
        owner = pwd.getpwnam("munge")
        run = Path("/run/munge")
        run.mkdir(exist_ok=True)
        os.chown(run, owner.pw_uid, owner.pw_gid)
        run.chmod(0o755)
        for stale in run.glob("munge*"):
            stale.unlink()
        self._run("munged", "runuser", "-u", "munge", "--", "munged", "-F", "--num-threads=2")
        self._wait("munged", lambda: _succeeds("munge", "-n"))

    def _start_accounting(self):
        # Not below the others' folder, into which its user may not look.
        self.database = Path(tempfile.mkdtemp(prefix="slurm-database-"))
        data, self.socket = self.database / "data", self.database / "socket"
        owner = pwd.getpwnam("mysql")
        os.chown(self.database, owner.pw_uid, owner.pw_gid)
        _require(
            *("mariadb-install-db", "--no-defaults", "--user=mysql"),
            *(f"--datadir={data}", "--skip-test-db"),
        )
        self._run(
            "mariadbd",
            *("mariadbd", "--no-defaults", "--user=mysql", "--skip-networking"),
            *(f"--datadir={data}", f"--socket={self.socket}", f"--pid-file={self.database}/pid"),
            "--innodb-lock-wait-timeout=900",  # slurmdbd wants it so
        )
        alive = ("mariadb-admin", "--no-defaults", f"--socket={self.socket}", "ping")
        self._wait("the database", lambda: _succeeds(*alive))
        self._run("slurmdbd", "slurmdbd", "-D", MYSQL_UNIX_PORT=str(self.socket))
        self._wait("slurmdbd", lambda: _succeeds("sacctmgr", "-i", "list", "cluster"))
        _require("sacctmgr", "-i", "add", "cluster", "fractalcontact")

    def _run(self, name, *command, **environment):
        with open(self.folder / f"log/{name}.out", "ab") as log:
            daemon = subprocess.Popen(
                command,
                stdout=log,
                stderr=log,
                env=os.environ | environment,
                start_new_session=True,
                preexec_fn=_end_with_parent,
            )
        self.daemons.append(daemon)
        return daemon

    def _wait(self, what, answers):
        until = time.monotonic() + PATIENCE
        while not answers():
            if time.monotonic() > until:
                logs = "\n".join(_tail(path) for path in sorted((self.folder / "log").iterdir()))
                raise RuntimeError(f"{what} does not answer after {PATIENCE} s:\n{logs}")
            time.sleep(0.2)


def _alive():
    """All processes of SLURM, of munge and of a database on this machine: id and name."""
    found = set()
    for entry in filter(str.isdigit, os.listdir("/proc")):
        with contextlib.suppress(OSError):  # it has ended
            name = Path(f"/proc/{entry}/comm").read_text(encoding="utf-8").strip()
            if name.startswith(("slurm", "munged", "mariadbd")):
                found.add(f"{entry} {name}")
    return found


def _megabytes(text):
    """Of a size as squeue writes it: 2000M, 4G."""
    return round(float(text[:-1]) * {"K": 1 / 1024, "M": 1, "G": 1024}[text[-1]])


def _minutes(text):
    """Of a time limit as squeue writes it: 5:00, 1:30:00, 1-00:00:00."""
    days, _, rest = text.rpartition("-")
    hours, minutes, seconds = ([0, 0, 0] + [int(word) for word in rest.split(":")])[-3:]
    return int(days or 0) * 1440 + hours * 60 + minutes + seconds // 60


def _is_of(number, folder):
    """Whether a process is a step of a job of SLURM, or works in it in a folder."""
    try:
        if Path(f"/proc/{number}/comm").read_text(encoding="utf-8").startswith("slurmstepd"):
            return True
        environment = Path(f"/proc/{number}/environ").read_bytes()
        return b"SLURM_JOB_ID=" in environment and os.readlink(f"/proc/{number}/cwd") == str(folder)
    except OSError:  # it has ended
        return False


def _end_with_parent():
    """Let the kernel end this process when its parent dies, however that ends."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)


def _tail(path):
    return f"{path.name}:\n" + "\n".join(
        path.read_text(errors="replace", encoding="utf-8").splitlines()[-15:]
    )


def _succeeds(*command):
    return subprocess.run(command, capture_output=True).returncode == 0


def _require(*command):
    done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8")
    if done.returncode:
        raise RuntimeError(f"{' '.join(command)}: {done.stdout[-1000:]}{done.stderr[-1000:]}")


def _end(daemon):
    """Tell a daemon and its children to end, then end them."""
    for number in (signal.SIGTERM, signal.SIGKILL):
        try:
            os.killpg(daemon.pid, number)
            daemon.wait(timeout=15)
            return
        except ProcessLookupError:
            daemon.wait()
            return
        except subprocess.TimeoutExpired:
            continue
