"""The reader process: what goes in comes out; whatever goes wrong in it is one clear error."""

import multiprocessing
import os
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

from fractalcontact.core.errors import InputError
from fractalcontact.scan import confined, reader_process, transfer
from fractalcontact.scan.confined import ReaderBug, read_confined
from fractalcontact.scan.format import Format
from fractalcontact.scan.options import ScanOptions, parse_options
from fractalcontact.scan.raw import RawScan

STATED = {
    "kind": "face",
    "layout": "matrix",
    "axes": "none",
    "unit": "mm",
    "spacing": 100,
    "first_row": "bottom",
    "heights": "up",
    "missing": "none",
}
OPTIONS = parse_options(STATED, "rock")


@pytest.fixture
def hostile(monkeypatch, tmp_path):
    """Write a file that makes its reader go wrong in a given way."""
    start = confined._START.replace("serve()", "import fractalcontact, hostile_reader; serve()")
    monkeypatch.setattr(confined, "_START", start)
    confined.stop_reader()

    def write(way, name="rock.npy"):
        (tmp_path / name).write_text(way)
        return tmp_path / name

    yield write
    confined.stop_reader()


@pytest.fixture
def rock(tmp_path):
    np.save(tmp_path / "rock.npy", np.arange(120.0).reshape(10, 12))
    return tmp_path / "rock.npy"


# --- what comes out is what the reader gave -----------------------------------------------------


def test_a_scan_comes_through_the_pipe_bit_by_bit(tmp_path):
    values = np.random.default_rng(0).normal(size=(30, 3))
    values[3, 2], values[4, 2] = np.nan, -0.0
    raw = RawScan(values[::2], "points", "r", "mm", None, (0.1, 0.2), "top", "up", ("é",))
    path = tmp_path / "sent"
    with open(path, "wb") as stream:
        transfer.send_scan(raw, stream)
    with open(path, "rb") as stream:
        back = transfer.receive_scan(transfer.from_text(stream.readline()), stream, 10**6)
    assert back.values.tobytes() == values[::2].tobytes()
    for field in (
        "layout",
        "reader",
        "unit_xy",
        "unit_z",
        "spacing",
        "first_row",
        "heights",
        "notes",
    ):
        assert getattr(back, field) == getattr(raw, field)


def test_what_breaks_off_or_promises_too_much_is_no_scan(tmp_path):
    path = tmp_path / "sent"
    with open(path, "wb") as stream:
        transfer.send_scan(RawScan(np.zeros((10, 10)), "matrix", "r"), stream)
    for most, size in ((10**6, path.stat().st_size - 1), (799, path.stat().st_size)):
        with open(path, "r+b") as stream:
            stream.truncate(size)
            head = transfer.from_text(stream.readline())
            assert transfer.receive_scan(head, stream, most) is None


def test_options_reach_the_reader(tmp_path):
    given = parse_options({"spacing": [0.1, "2 um"], "columns": ["x", 1, 2], "missing": -1}, "rock")
    sent = transfer.from_text(transfer.to_text({"options": given.stated()}))
    assert ScanOptions(**sent["options"]) == given
    np.savez(tmp_path / "rock.npz", a=np.zeros((9, 9)), b=np.arange(30.0).reshape(10, 3))
    keys = {"variable": "b", "layout": "points", "columns": [1, 2, 0], "kind": "face"}
    keys |= {"unit": "mm", "heights": "up", "missing": "none"}
    options = parse_options(keys, "rock.npz")
    raw = read_confined(tmp_path / "rock.npz", options)
    np.testing.assert_array_equal(raw.values, np.arange(30.0).reshape(10, 3)[:, [1, 2, 0]])


def test_a_relative_path_is_relative_to_the_present_folder(rock, monkeypatch):
    read_confined(rock, OPTIONS)
    (rock.parent / "deeper").mkdir()
    monkeypatch.chdir(rock.parent / "deeper")
    assert read_confined(type(rock)("../rock.npy"), OPTIONS).values.shape == (10, 12)
    with pytest.raises(InputError, match=r"^other\.npy: "):
        read_confined(type(rock)("other.npy"), OPTIONS)


def test_one_process_serves_all_files(rock):
    read_confined(rock, OPTIONS)
    first = confined._server.process.pid
    read_confined(rock, OPTIONS)
    assert confined._server.process.pid == first


# --- what goes wrong is one clear error, and the next file is read ------------------------------


@pytest.mark.parametrize(
    ("way", "message"),
    [
        ("hang", r"took longer than 1 s of processor time"),
        ("eat", r"ran out of memory \(0\.1 GiB allowed\)"),
        ("eat within a library", r"ran out of memory"),
        ("crash", r"crashed \(signal 11\)"),
        ("abort", r"crashed \(signal 6\)"),
        ("leave", r"ended without a result"),
    ],
)
def test_a_reader_that_goes_wrong_is_one_error(hostile, way, message):
    if way.startswith("eat") and sys.platform == "darwin":
        pytest.skip("macOS does not bound the address space")
    path = hostile(way)
    with pytest.raises(InputError, match=rf"rock\.npy: (the reader|reading) {message}") as error:
        read_confined(path, OPTIONS)
    assert "export it again" in str(error.value)
    assert read_confined(hostile("fine"), OPTIONS).notes == ("fine",)


def test_a_reader_that_waits_for_ever_is_ended(hostile, monkeypatch):
    impatient = "fractalcontact.scan.reader_process.PATIENCE = 2; serve()"
    monkeypatch.setattr(confined, "_START", confined._START.replace("serve()", impatient))
    with pytest.raises(InputError, match=r"rock\.npy: reading took longer than 2 s;"):
        read_confined(hostile("sleep"), OPTIONS)


def test_a_reader_can_write_no_file_and_open_few(hostile, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputError, match="could not write"):
        read_confined(hostile("write"), OPTIONS)
    assert not any(p.stat().st_size for p in tmp_path.rglob("written*"))
    with pytest.raises(InputError, match=r"could not open: .*Too many open files"):
        read_confined(hostile("open"), OPTIONS)


def test_an_error_is_short_and_harmless_on_a_terminal(hostile):
    with pytest.raises(InputError, match=r"export it again$") as error:
        read_confined(hostile("quote"), OPTIONS)
    assert len(str(error.value)) < 1700
    assert "\\x1b[31m" in str(error.value)


def test_a_result_of_any_other_shape_is_refused(hostile):
    with pytest.raises(InputError, match=r"rock\.npy: .* an array of shape \(2, 8, 10\)"):
        read_confined(hostile("stack"), OPTIONS)


def test_a_fault_of_the_program_is_not_blamed_on_the_file(hostile):
    with pytest.raises(ReaderBug, match=r"rock\.npy: KeyError: 'no such key'") as bug:
        read_confined(hostile("bug"), OPTIONS)
    assert "hostile_reader.py" in bug.value.__notes__[0]


def test_limits_grow_with_the_file_as_its_most_generous_format_declares():
    plain = [Format(read=None)]
    small, large = (reader_process.limits_for(size, plain) for size in (1000, 300 * 10**6))
    assert small.memory < 1.1 * 1024**3
    assert small.processor_seconds < 10
    assert large.memory > 3 * 10**9
    generous = Format(read=None, memory_per_byte=100, seconds_per_megabyte=7)
    found = reader_process.limits_for(10**6, [*plain, generous])
    assert found.memory == reader_process.BASE_MEMORY + 100 * 10**6
    assert found.processor_seconds == reader_process.BASE_SECONDS + 7
    assert found.seconds == reader_process.PATIENCE * found.processor_seconds


def test_an_archive_may_take_memory_for_what_it_inflates_to(hostile, tmp_path):
    # 128 MB of heights from 16 MB within 16 kB, and 100 MB allowed without the archive's own share.
    path = hostile("inflate", "rock.npz")
    np.savez_compressed(path, np.zeros((4000, 4000), np.int8))
    assert read_confined(path, OPTIONS).values.shape == (4000, 4000)


# --- processes and threads ----------------------------------------------------------------------


def test_a_killed_reader_process_is_replaced(rock):
    read_confined(rock, OPTIONS)
    process = confined._server.process
    process.kill()
    process.wait()
    assert read_confined(rock, OPTIONS).values.shape == (10, 12)


def test_threads_get_their_own_answers(tmp_path):
    found = {}

    def read(number):
        np.save(tmp_path / f"{number}.npy", np.full((9, 9), number))
        found[number] = read_confined(tmp_path / f"{number}.npy", OPTIONS).values

    threads = [threading.Thread(target=read, args=(number,)) for number in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sorted(found) == list(range(8))
    assert all((values == number).all() for number, values in found.items())


def test_a_forked_process_has_a_reader_of_its_own(rock):
    read_confined(rock, OPTIONS)
    context = multiprocessing.get_context("fork")
    with context.Pool(2) as pool:
        shapes = pool.starmap(_read_shape, [(rock,)] * 4)
    assert shapes == [(10, 12)] * 4
    assert read_confined(rock, OPTIONS).values.shape == (10, 12)


def _read_shape(path):
    return read_confined(path, OPTIONS).values.shape


def test_the_reader_process_ends_with_its_parent(rock):
    script = (
        "import os, pathlib, sys; from fractalcontact.scan import confined, options; "
        f"confined.read_confined(pathlib.Path(sys.argv[1]), options.parse_options({STATED}, '')); "
        "print(confined._server.process.pid, flush=True); os.kill(os.getpid(), 9)"
    )
    done = subprocess.run(
        [sys.executable, "-c", script, str(rock)], capture_output=True, text=True, timeout=60
    )
    pid = int(done.stdout)
    deadline = time.monotonic() + 10
    while _exists(pid) and time.monotonic() < deadline:
        time.sleep(0.02)
    assert not _exists(pid)
    assert done.stderr == ""


def _exists(pid):
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    # An orphan that has ended may wait for init to notice.
    status = subprocess.run(["ps", "-o", "stat=", "-p", str(pid)], capture_output=True, text=True)
    return not status.stdout.strip().startswith("Z")


def test_a_script_without_a_main_guard_runs_once(rock, tmp_path):
    script = tmp_path / "script.py"
    script.write_text(
        "import sys\nfrom fractalcontact.scan.read import read_scan\n"
        f"print(read_scan(sys.argv[1], {STATED}).shape)\n"
    )
    done = subprocess.run(
        [sys.executable, str(script), str(rock)], capture_output=True, text=True, timeout=60
    )
    assert (done.stdout, done.stderr) == ("(10, 12)\n", "")
