"""A process that solves one cell of `beside_peers.py` with one solver, and whoever asks it to.

    python benchmarks/peers_worker.py TASK

The task is one object of JSON: a surface to make and the loads to find on it, or a solver and what
it is to solve each time that a line comes on standard input. What was measured goes out as a line
of JSON. Libraries take their threads from the environment that the process begins with, which is
why each solver has a process of its own.
"""

import json
import os
import select
import subprocess
import sys
from pathlib import Path

import numpy as np

RMS = 0.02
#: The fraction in contact is met to this: it names a cell and decides nothing.
MET = 0.05
#: Windows with more nodes along a side have single precision heights in a file mapped to memory.
MAPPED = 4096
#: Of more nodes along a side the surface is made in single precision too: in double, 16384 nodes
#: along a side take more than 22 GB.
LARGEST_IN_DOUBLE = 8192
#: Our solver, as its rows are named: what belongs to the grid is made anew in each solve, or kept.
OURS = ("ours, with set-up", "ours, without")
#: Seconds to load a surface and to judge an answer, beside those of the solve.
JUDGING = 60
#: What is wrong with a solve that took longer than the limit begins with this.
TOO_LONG = "longer than"


class Worker:
    """A process that solves one cell with one solver each time it is asked to.

    Parameters
    ----------
    name : str
        Of :data:`OURS`, or of a peer.
    load : dict
        What :func:`run_once` made of the cell.
    threads : int
    limit : float
        Of one solve, seconds. After the first that takes longer, or fails, there is none.
    """

    def __init__(self, name, load, threads, limit):
        self.limit, self.failed, self.rtol = limit, None, None
        self.process = _process({"solver": name, **load}, threads)

    def judge(self, rtol):
        """As :meth:`solve`, counters, force and closure too; later solves have this tolerance."""
        self.rtol = rtol
        # The first loads the surface as well.
        return self._answer({"rtol": rtol, "judge": True}, self.limit + JUDGING)

    def solve(self):
        """Report of the process: its seconds, or how it failed."""
        return self._answer({"rtol": self.rtol, "judge": False}, self.limit)

    def _answer(self, question, wait):
        if self.failed is not None:
            return {"failed": self.failed}
        self.process.stdin.write(json.dumps(question) + "\n")
        self.process.stdin.flush()
        ready, _, _ = select.select([self.process.stdout], [], [], wait)
        line = self.process.stdout.readline() if ready else ""
        late = f"{TOO_LONG} {self.limit:g} s"
        found = json.loads(line) if line else {"failed": "its process ended" if ready else late}
        if "failed" in found or found["clock"] > self.limit:
            self.failed = found.get("failed", late)
            self.process.kill()
            return {"failed": self.failed}
        return found

    def end(self):
        """Let the process end."""
        self.process.stdin.close()
        self.process.wait()


def _process(what, threads):
    environment = os.environ | {"OMP_NUM_THREADS": str(threads), "OPENBLAS_NUM_THREADS": "1"}
    command = [sys.executable, __file__, json.dumps(what)]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    return subprocess.Popen(command, env=environment, text=True, **pipes)


def run_once(what):
    """The one line that a process of its own prints."""
    output, _ = _process(what, 1).communicate()
    return json.loads(output)


# What is measured: in a process of its own.


def _work(what):
    if "make" in what:
        sys.stdout.write(json.dumps(_made(what)))
        return
    solve = _ours(what) if what["solver"] in OURS else _peer(what)
    for line in sys.stdin:
        sys.stdout.write(json.dumps(_timed(solve, what, **json.loads(line))) + "\n")
        sys.stdout.flush()


def _heights(what):
    heights = np.load(what["heights"], mmap_mode="r", allow_pickle=False)
    return heights if heights.dtype == np.float32 else np.array(heights)


def _timed(solve, what, rtol, judge):
    """One solve: its seconds and counters; where it is to be judged, closure and force too."""
    import resource
    import time

    clock, processor = time.perf_counter(), time.process_time()
    try:
        pressure, space, work, path = solve(rtol, judge)
    except Exception as error:  # a public code raises whatever it raises: the row says it
        return {"failed": str(error) or type(error).__name__}
    clock, processor = time.perf_counter() - clock, time.process_time() - processor
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    work = work[1:] or work
    applications = "" if None in work else round(float(np.mean(work)), 1)
    found = {"clock": clock, "processor": processor, "applications": applications, "path": path}
    found["peak"] = peak * (1 if sys.platform == "darwin" else 1024) / 1e9
    if judge:
        found["force"] = float(pressure.sum(dtype=float)) * space.cell_area
        found["closure"] = what["steps"][-1]["closure"]
        if what["judged"]:
            found["closure"] = _closure(pressure, space, _heights(what))
    return found


def _closure(pressure, space, heights):
    """The closure that a pressure belongs to: its mean over the load, mm."""
    reached = space.displacement(np.asarray(pressure, float)) + (heights.max() - heights)
    return float((pressure * reached).sum() / pressure.sum(dtype=float))


def _space(heights):
    from fractalcontact import HalfSpace

    ny, nx = heights.shape
    return HalfSpace((ny, nx), (1 / ny, 1 / nx), 1.0)


def _ours(what):
    """Ours: with set-up, it keeps nothing of a grid from one solve to the next."""
    from fractalcontact import solve_contact
    from roughcontact.contact.preconditioner import forget_preconditioner
    from roughcontact.contact.state import CandidateState
    from roughcontact.elastic.block_influence import forget_matrices

    heights = _heights(what)
    kept = _space(heights)

    def solve(rtol, _):
        space, state, work = kept, None, []
        if what["solver"] == OURS[0]:
            space = _space(heights)
            forget_matrices()
        forget_preconditioner(space)
        for step in what["steps"]:
            state = solve_contact(heights, space, force=step["force"], start=state, rtol=rtol)
            work.append(state.iterations)
        path = f"convolution, residual {state.residual:.1e}"
        if isinstance(state, CandidateState):
            path = f"{state.candidates} candidates, residual {state.residual:.1e}"
        return state.pressure, state.space, work, path

    return solve


def _peer(what):
    """A public code or method of the package, set up and solved anew each time."""
    from contactlab.methods.peers import Load
    from contactlab.methods.registry import METHODS, PEERS

    heights = _heights(what)
    method = {**METHODS, **PEERS}[what["solver"]]
    control = method.loads[0]

    def of_the_package(rtol, _):
        space, state, work = _space(heights), None, []
        for step in what["steps"]:
            state = method(heights, space, start=state, rtol=rtol, **{control: step[control]})
            work.append(state.iterations if method.counts == "applications" else None)
        return state.pressure, space, work, ""

    def public(rtol, count):
        code, pressure, work = method.set_up(heights, _space(heights)), None, []
        for step in what["steps"]:
            code.count(count)
            load = {control: step[control], "pixel_force": step["force"] / step["nodes"]}
            pressure = code.solve(Load(**load, start=pressure), rtol)
            work.append(code.applications if count else None)
        return pressure, code.space, work, code.path

    return public if method.packages else of_the_package


def _made(what):
    """Make a surface if there is none, and find the loads up to that of the fraction in contact."""
    from fractalcontact import solve_contact
    from fractalcontact.surface.synthesis import self_affine

    path, size = Path(what["make"]), what["size"]
    if not path.exists():
        if size > LARGEST_IN_DOUBLE:
            heights = in_single_precision(size, what["hurst"], what["seed"])
        else:
            heights = self_affine((size, size), 1 / size, what["hurst"], rms=RMS, seed=what["seed"])
        np.save(path, heights if size <= MAPPED else heights.astype(np.float32, copy=False))
    heights = _heights({"heights": path})
    space, wanted = _space(heights), what["contact"] / 100
    force, state, low, high = RMS * wanted, None, 0.0, np.inf
    for _ in range(40):
        state = solve_contact(heights, space, force=force, start=state, rtol=1e-4)
        ratio = state.area / wanted
        if abs(ratio - 1) <= MET:
            break
        low, high = (force, high) if ratio < 1 else (low, force)
        trial = force / ratio
        force = trial if low < trial < high else (low + min(high, 4 * low)) / 2
    steps, rtol = [], 1e-8 if what["judge"] else 1e-4
    last, lower = solve_contact(heights, space, force=force, start=state, rtol=rtol), None
    for closure in last.closure * np.arange(1, what["loads"]) / what["loads"]:
        lower = solve_contact(heights, space, closure=closure, start=lower, rtol=rtol)
        steps.append(_step(lower, closure, lower.force))
    exact = last.closure
    if what["judge"]:
        exact = _closure(last.pressure, space, np.asarray(heights, float))
    return {"steps": [*steps, _step(last, exact, force)], "judged": what["judge"]}


def _step(state, closure, force):
    return {"closure": closure, "force": force, "nodes": int(np.count_nonzero(state.in_contact))}


def in_single_precision(size, hurst, seed):
    """The surface of ``self_affine``, but for rounding: its noise is filtered row by row."""
    import scipy.fft

    from fractalcontact.surface.synthesis import grid_side, levelled

    side = grid_side((size, size))
    generator = np.random.Generator(np.random.PCG64(seed))
    noise = np.empty((side, side), np.float32)
    for row in noise:
        row[:] = generator.standard_normal(side)
    spectrum = scipy.fft.rfft2(noise, overwrite_x=True)
    del noise
    along_x = scipy.fft.rfftfreq(side)
    for row, along_y in zip(spectrum, scipy.fft.fftfreq(side), strict=True):
        waves = np.hypot(along_x, along_y)
        waves[waves == 0] = np.inf
        row *= (waves ** -(1 + hurst)).astype(np.float32)
    patch = scipy.fft.irfft2(spectrum, (side, side), overwrite_x=True)[:size, :size].copy()
    del spectrum
    return levelled(patch, RMS).astype(np.float32)


if __name__ == "__main__":
    _work(json.loads(sys.argv[1]))
