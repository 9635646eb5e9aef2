"""One half-space in several threads, and processes forked at any moment."""

import gc
import multiprocessing
import threading
import time
import weakref
from concurrent.futures import ThreadPoolExecutor

import numba
import numpy as np
import pytest
from ensembles import ensemble
from numba.core.compiler_lock import global_compiler_lock
from rough_surfaces import self_affine

from roughcontact import HalfSpace, solve_contact
from roughcontact.contact import preconditioner as preconditioning
from roughcontact.contact.effort import SOLVING, Effort
from roughcontact.contact.preconditioner import forget_preconditioner, preconditioner
from roughcontact.elastic import convolution
from roughcontact.threads import computed_once, in_parts

THREADS = ensemble("threads")
#: Seconds after which a process counts as hanging, on however busy a machine.
PATIENCE = 600


def pressed(n, closures, hardness=()):
    """A rough surface, its half-space, and loads: some with a hardness, as a share of the peak."""
    height = self_affine((n, n), 0.1, 0.8, rms=0.1, seed=n)
    loads = [{"closure": closure} for closure in closures]
    loads += [{"closure": closures[-1], "hardness": h} for h in hardness]
    return height, HalfSpace((n, n), (0.1, 0.1), 20e3), loads


def threaded_from(side):
    """Cells from which convolutions are done in parts: a grid of this side is."""
    return min(convolution.THREADED_CELLS, side**2)


def states_of(problem, order):
    """Bits of the states of all loads in an order, and of a load step from each."""
    height, space, loads = problem
    bits = {}
    for k in order:
        cold = solve_contact(height, space, **loads[k])
        warm = solve_contact(height, space, start=cold, force=0.7 * cold.force)
        bits[k] = [
            (state.pressure.tobytes(), state.displacement.tobytes(), state.closure, state.stiffness)
            for state in (cold, warm)
        ]
    return bits


def alike_in_threads():
    """What the test of this name does, in a process of its own: what crashes it fails the test."""
    loads = {
        48: ([0.05, 0.2, 0.4], [500.0]),
        96: ([0.1, 0.3], [500.0]),
        200: ([0.1, 0.3], [500.0]),
        400: ([0.2], []),
    }
    sides = ensemble("sides solved by threads")
    convolution.THREADED_CELLS = threaded_from(max(sides))
    problems = [pressed(n, *loads[n]) for n in sides]
    expected, before = [], SOLVING.problems
    for height, space, loads in problems:
        own = HalfSpace(space.shape, space.spacing, space.modulus)
        expected.append(states_of((height, own, loads), range(len(loads))))
    alone = SOLVING.problems - before
    begin = threading.Barrier(THREADS)

    def work(thread):
        begin.wait()
        # Each at another load, all on the same spaces at once.
        return [states_of(problem, np.roll(range(len(problem[2])), thread)) for problem in problems]

    before = SOLVING.problems
    with ThreadPoolExecutor(THREADS) as pool:
        for found in pool.map(work, range(THREADS)):
            assert found == expected
    # Two of each load, and two more for the slope of each that yields.
    assert alone >= 2 * sum(len(problem[2]) for problem in problems)
    assert SOLVING.problems - before == THREADS * alone


def run(target, method, *arguments):
    """End of a process that runs a function of this module; killed if it hangs."""
    process = multiprocessing.get_context(method).Process(target=target, args=arguments)
    process.start()
    process.join(PATIENCE)
    hangs = process.is_alive()
    if hangs:
        process.kill()
        process.join()
    return "hangs" if hangs else process.exitcode


def test_threads_on_one_space_find_the_bits_of_one_alone():
    assert run(alike_in_threads, "spawn") == 0


def test_each_thread_keeps_a_preconditioner_of_its_own_for_each_space():
    space, equal = (HalfSpace((20, 20), (0.1, 0.1), 1.0) for _ in range(2))
    mine = preconditioner(space)
    assert preconditioner(space) is mine
    assert preconditioner(equal) is not mine
    with ThreadPoolExecutor(1) as other:
        assert other.submit(preconditioner, space).result() is not mine
    forget_preconditioner(space)
    assert preconditioner(space) is not mine


def test_preconditioners_end_with_their_space_and_with_their_thread():
    gc.disable()  # not with the next garbage collection, which may be long to come
    try:
        space = HalfSpace((200, 190), (0.1, 0.1), 1.0)
        here = weakref.ref(preconditioner(space))
        with ThreadPoolExecutor(1) as other:
            there = weakref.ref(other.submit(preconditioner, space).result())
        assert there() is None
        assert here() is not None
        key = id(space)
        del space
        assert here() is None
        assert key not in preconditioning._THREAD.kept
    finally:
        gc.enable()


def test_a_space_does_not_change():
    space = HalfSpace((20, 20), (0.1, 0.1), 1.0)
    for name in ("shape", "spacing", "modulus", "kernel", "cell"):
        with pytest.raises(AttributeError, match="make another HalfSpace"):
            setattr(space, name, getattr(space, name))


def test_what_is_lazy_is_made_once_and_without_a_lock():
    class Made:
        count = 0

        @computed_once
        def thing(self):
            """Documented."""
            self.count += 1
            if self.count == 1:
                begun.set()
                go_on.wait(PATIENCE)
            return object()

    begun, go_on = threading.Event(), threading.Event()
    made = Made()
    assert Made.thing.__doc__ == "Documented."
    with ThreadPoolExecutor(1) as other:
        late = other.submit(lambda: made.thing)
        begun.wait(PATIENCE)
        first = made.thing  # does not wait for the other
        go_on.set()
        assert late.result() is first is made.thing
    assert made.count == 2


def test_effort_of_several_threads_is_counted_in_full():
    effort = Effort()

    def work(_):
        for _ in range(2000):
            with effort.counted(1):
                pass

    with ThreadPoolExecutor(THREADS) as pool:
        list(pool.map(work, range(THREADS)))
    assert effort.problems == 2000 * THREADS


# Forks


def bits_of_large():
    """Pressure of a solve that takes the thread pool, in every process the same."""
    height, space, (load,) = pressed(ensemble("side solved in forks"), [0.2])
    return solve_contact(height, space, **load).pressure.tobytes()


def expect(bits):
    assert bits_of_large() == bits


@pytest.fixture
def two_threads(monkeypatch):
    monkeypatch.setenv("OMP_NUM_THREADS", "2")
    threaded = threaded_from(ensemble("side solved in forks"))
    monkeypatch.setattr(convolution, "THREADED_CELLS", threaded)


def test_a_fork_after_a_large_solve_solves(two_threads):
    bits = bits_of_large()
    assert run(expect, "fork", bits) == 0
    # And the parent goes on.
    assert bits_of_large() == bits


def test_a_fork_of_a_fork_solves(two_threads):
    bits = bits_of_large()

    def child():
        expect(bits)
        assert run(expect, "fork", bits) == 0

    assert run(child, "fork") == 0


def test_forks_made_while_another_thread_solves(two_threads):
    bits, done = bits_of_large(), threading.Event()

    def solve_on():
        height, space, (load,) = pressed(ensemble("side solved in forks"), [0.2])
        while not done.is_set():
            # Everything that is kept is made again: a fork may come at any of these moments.
            space = HalfSpace(space.shape, space.spacing, space.modulus)
            state = solve_contact(height, space, **load)
            assert state.pressure.tobytes() == bits
            assert state.stiffness > 0

    with ThreadPoolExecutor(1) as other:
        solving = other.submit(solve_on)
        try:
            for k in range(ensemble("forks")):
                time.sleep(0.013 * k)
                assert run(expect, "fork", bits) == 0
        finally:
            done.set()
        solving.result()


def test_a_fork_made_while_another_thread_works_out_what_is_kept(monkeypatch):
    """The moment at which `functools.cached_property` would leave a lock taken for ever."""
    inside, go_on = threading.Event(), threading.Event()
    spectrum = HalfSpace._spectrum

    def slow_spectrum(space):
        if threading.current_thread() is not threading.main_thread():
            inside.set()
            go_on.wait(PATIENCE)
        return spectrum(space)

    monkeypatch.setattr(HalfSpace, "_spectrum", slow_spectrum)
    height, space, (load,) = pressed(48, [0.2])
    with ThreadPoolExecutor(1) as other:
        waiting = other.submit(solve_contact, height, space, **load)
        inside.wait(PATIENCE)
        try:
            assert run(solve_contact_quietly, "fork", height, space, load) == 0
        finally:
            go_on.set()
        assert waiting.result().force > 0


def solve_contact_quietly(height, space, load):
    assert solve_contact(height, space, **load).stiffness > 0


def compile_something():
    assert numba.njit(lambda x: x + 1)(1) == 2


def test_a_fork_made_while_another_thread_compiles():
    held = threading.Event()

    def compile_for_long():
        with global_compiler_lock:
            held.set()
            time.sleep(0.5)

    with ThreadPoolExecutor(1) as other:
        compiling = other.submit(compile_for_long)
        held.wait(PATIENCE)
        assert run(compile_something, "fork") == 0
        compiling.result()
    compile_something()


def test_a_fork_made_while_effort_is_counted():
    SOLVING._lock.acquire()
    try:
        height, space, (load,) = pressed(48, [0.2])
        assert run(solve_contact_quietly, "fork", height, space, load) == 0
    finally:
        SOLVING._lock.release()


def test_parts_cover_the_range_in_a_fork_too(two_threads):
    def cover():
        hit = np.zeros(1000, int)

        def mark(start, stop):
            hit[start:stop] += 1

        in_parts(mark, hit.size, smallest=1)
        assert (hit == 1).all()

    cover()
    assert run(cover, "fork") == 0
