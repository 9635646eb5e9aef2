"""Tables of `beside_peers.py`: rows read and written, growth with the nodes, and a summary."""

import csv
import os
import platform
from importlib.metadata import PackageNotFoundError, version

import numpy as np

from contactlab.methods.registry import PEERS

COLUMNS = (
    *("size", "contact", "threads", "hurst", "loads", "solver", "seconds", "ours", "times", "low"),
    *("high", "pairs", "error", "note", "tolerance", "applications", "path", "peak GB"),
)


#: Columns that tell cells of one size apart.
_KIND = ("contact", "threads", "hurst", "loads")


def growth(rows, column):
    """Exponent of the power law of a column over the nodes, of each solver and kind of cell.

    Parameters
    ----------
    rows : list of dict
        Of the table.
    column : str
        ``"seconds"`` or ``"peak GB"``.

    Yields
    ------
    solver, contact, threads, hurst, loads : str
    exponent, error : float
        The error is the standard error of a least-squares fit, NaN of two sizes.
    """
    groups: dict[tuple, list] = {}
    for row in rows:
        if row.get(column) not in (None, "") and not row.get("note"):
            key = row["solver"], *(str(row[name]) for name in _KIND)
            groups.setdefault(key, []).append((2 * np.log(int(row["size"])), float(row[column])))
    for key, points in groups.items():
        x, y = np.array(points).T
        if len(set(x)) < 2:
            continue
        y = np.log(y)
        slope, offset = np.polyfit(x, y, 1)
        rest, spread = y - slope * x - offset, ((x - x.mean()) ** 2).sum()
        error = np.sqrt((rest**2).sum() / (len(x) - 2) / spread) if len(x) > 2 else np.nan
        yield *key, slope, error


def read(folder):
    """Rows of the table in a folder, every value as text; none where there is no table."""
    path = folder / "beside_peers.csv"
    if not path.exists():
        return []
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def write(folder, rows):
    """Both tables; returns that for reading."""
    with (folder / "beside_peers.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS)
        writer.writeheader()
        writer.writerows(rows)
    lines = [_versions(), "", "| " + " | ".join(COLUMNS) + " |", "|" + "---|" * len(COLUMNS)]
    for row in rows:
        lines.append("| " + " | ".join(_text(row.get(column)) for column in COLUMNS) + " |")
    lines += ["", *(f"- {line}" for line in summary(rows)), ""]
    for column in ("seconds", "peak GB"):
        for solver, *kind, exponent, error in growth(rows, column):
            law = f"{column} grow as nodes^{exponent:.2f}"
            law += f" +- {error:.2f}" if np.isfinite(error) else ""
            of = ", ".join(f"{name} {value}" for name, value in zip(_KIND, kind, strict=True))
            lines.append(f"- {solver}, {of}: {law}")
    text = "\n".join(lines) + "\n"
    (folder / "beside_peers.md").write_text(text, encoding="utf-8")
    return text


def summary(rows):
    """Time of the fastest peer over ours, in the median of light and dense contact."""
    best: dict[tuple, float] = {}
    for row in rows:
        if row.get("times") not in (None, "") and not row.get("note"):
            key = tuple(float(row[name]) for name in ("size", *_KIND))
            best[key] = min(best.get(key, np.inf), float(row["times"]))
    for threads in sorted({key[2] for key in best}):
        here = {key: times for key, times in best.items() if key[2] == threads}
        yield f"{threads:g} threads: least {min(here.values()):.2g} times, in {len(here)} cells"
        for name, of in (("below 0.5 %", lambda f: f < 0.5), ("above 2 %", lambda f: f > 2)):
            some = [times for key, times in here.items() if of(key[1])]
            if some:
                yield f"{threads:g} threads, {name}: {np.median(some):.2g} times in the median"


def _versions():
    """Programs that were measured, and the machine."""
    packages = ["fractalcontact", "numpy", "scipy", "numba"]
    packages += dict.fromkeys(package for peer in PEERS.values() for package in peer.packages)
    named = [f"Python {platform.python_version()}, {os.cpu_count()} cores"]
    for package in packages:
        try:
            named.append(f"{package} {version(package)}")
        except PackageNotFoundError:
            named.append(f"{package} not installed")
    return ", ".join(named)


def _text(value):
    try:
        return f"{float(value):.3g}" if "." in str(value) or "e" in str(value) else str(value or "")
    except (TypeError, ValueError):
        return str(value or "")
