"""Plan of a run: its jobs, which may read the study again later, must find the same.

On a cluster every job reads the study when it begins, hours after the run was planned. What is made
of another scan, or with other settings, would be taken for what was planned: no later run would see
it, if the old one was put back meanwhile.
"""

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..core.atomic import atomic_write
from ..core.errors import InputError

#: A plan: digest of the study, of what is said of each specimen, and checksums of scan files.
Plan = dict[str, Any]


def plan_of(
    study: Mapping[str, Any],
    settings: Mapping[str, Mapping],
    options: Mapping[str, Mapping],
) -> Plan:
    """Plan of a run, but for the key ``scans``: SHA-256 of scan files by path.

    Parameters
    ----------
    study : mapping
        As read from YAML.
    settings, options : mapping of str to mapping
        By specimen: what is computed of it, and how its scan is read.
    """
    said = {
        name: _digest([settings.get(name), options.get(name)]) for name in {*settings, *options}
    }
    return {"study": _digest(study), "specimens": said}


def write_plan(path: Path | str, plan: Plan) -> None:
    """Store the plan for the jobs of the run.

    Raises
    ------
    OutputError
        If it cannot be written.
    """
    with atomic_write(path) as temporary:
        temporary.write_text(json.dumps(plan), encoding="utf-8")


def read_plan(path: Path | str) -> Plan:
    """The plan of the run that a job belongs to.

    Raises
    ------
    InputError
        If there is none: nobody knows then with what the job should work.
    """
    try:
        return dict(json.loads(Path(path).read_text(encoding="utf-8")))
    except (OSError, ValueError) as error:
        raise InputError(
            f"{path}: cannot be read ({error}); this file holds the plan of the run, and the next "
            "run writes it again"
        ) from error


def changed_since(plan: Plan, now: Plan, source: str) -> str:
    """Differences from the plan of the run; empty if none.

    Specimens that came or went concern no job of the others. Scan files are left to the jobs that
    read them.

    Parameters
    ----------
    plan, now : dict
        From :func:`plan_of`.
    source : str
        The file the study comes from.
    """
    if plan["study"] != now["study"]:
        return f"{source}: changed while the study ran; run it again"
    for name, said in now["specimens"].items():
        if plan["specimens"].get(name, said) != said:
            return f"{name}: its sidecar or table changed while the study ran; run it again"
    return ""


def _digest(found: Any) -> str:
    text = json.dumps(found, sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()[:16]
