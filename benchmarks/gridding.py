"""Time and memory of reading and gridding millions of points, by `python gridding.py`."""

import argparse
import logging
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

SPACING = 0.01  # mm: root of the area per point
FORMATS = ("npy", "ply", "xyz")


def random_points(n, rng):
    """Points of a rough surface anywhere in a square."""
    return rng.uniform(0, SPACING * np.sqrt(n), (n, 2))


def jittered_points(n, rng):
    """Points near the nodes of a square lattice."""
    side = round(np.sqrt(n))
    nodes = np.stack(np.meshgrid(np.arange(side), np.arange(side)), axis=-1).reshape(-1, 2)
    return SPACING * (nodes + rng.uniform(-0.4, 0.4, nodes.shape))


CLOUDS = {"random": random_points, "jittered": jittered_points}


def add_heights(xy, rng):
    """Waves of three lengths, and noise."""
    x, y = xy.T
    side = xy.max()
    waves = sum(
        side / 50 / k * np.sin(2 * np.pi * (k * x + 2 * y) / side + k) for k in (1.0, 7.0, 45.0)
    )
    return np.column_stack([xy, waves + rng.normal(0, SPACING / 20, len(xy))])


def write_cloud(path, points):
    """Write points as numpy array, binary PLY (double precision) or text."""
    if path.suffix == ".npy":
        np.save(path, points)
    elif path.suffix == ".ply":
        properties = "".join(f"property double {axis}\n" for axis in "xyz")
        head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n{properties}"
        with path.open("wb") as stream:
            stream.write(f"{head}end_header\n".encode())
            points.astype("<f8").tofile(stream)
    else:
        np.savetxt(path, points, fmt="%.6f")


class ReaderPeak(logging.Handler):
    """Most memory of the process that reads the file, as the package logs it."""

    def emit(self, record):
        """Keep the peak, in GB."""
        _, _, kilobytes, _ = record.args
        self.gigabytes = kilobytes * 1024 / 1e9


#: What the sidecar of a cloud in three columns states.
STATED = {
    "kind": "face",
    "layout": "points",
    "columns": [0, 1, 2],
    "unit": "mm",
    "heights": "up",
    "missing": "none",
}


def read_cloud(path, grid):
    """Read the file as a study would and print what it took; meant for a process of its own."""
    from fractalcontact.scan.read import read_scan

    reader = ReaderPeak()
    log = logging.getLogger("fractalcontact.scan.confined")
    log.setLevel(logging.DEBUG)
    log.addHandler(reader)
    options = STATED | ({"grid": f"{grid} mm"} if grid else {})
    if str(path).endswith(".xyz"):
        options |= {"delimiter": "blank", "decimal": ".", "header": 0}
    start = time.perf_counter()
    heights = read_scan(path, options)
    seconds = time.perf_counter() - start
    usage = resource.getrusage(resource.RUSAGE_SELF)
    busy, peak = usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024 / 1e9
    cells = " x ".join(map(str, heights.shape))
    missing = heights.attrs["missing_share"]
    sys.stdout.write(
        f"{seconds:8.1f} {busy:6.1f} {reader.gigabytes:9.2f} {peak:8.2f} {cells:>15} "
        f"{missing:9.2%}\n"
    )


def main(arguments):
    """Make the points, read them in a process of their own, and write a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--points", type=int, default=10_000_000)
    parser.add_argument("--clouds", nargs="+", choices=CLOUDS, default=list(CLOUDS))
    parser.add_argument("--formats", nargs="+", choices=FORMATS, default=list(FORMATS))
    parser.add_argument("--grid", type=float, help="spacing in mm; default: that of the points")
    parser.add_argument("--read", type=Path, help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    if options.read:
        read_cloud(options.read, options.grid)
        return
    # The process that reads has ended before the one that grids reaches its peak.
    sys.stdout.write(
        "cloud    file   points  seconds  CPU s reader GB  peak GB           cells   missing\n"
    )
    grid = ["--grid", str(options.grid)] if options.grid else []
    with tempfile.TemporaryDirectory() as folder:
        for name in options.clouds:
            rng = np.random.default_rng(0)
            points = add_heights(CLOUDS[name](options.points, rng), rng)
            for suffix in options.formats:
                path = Path(folder) / f"cloud.{suffix}"
                write_cloud(path, points)
                sys.stdout.write(f"{name:8} {suffix:4} {len(points):8}")
                sys.stdout.flush()
                subprocess.run([sys.executable, __file__, "--read", path, *grid], check=True)
                path.unlink()


if __name__ == "__main__":
    main(sys.argv[1:])
