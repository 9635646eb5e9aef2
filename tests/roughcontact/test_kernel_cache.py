"""Compiled kernels follow every change of what they are compiled from, and nothing damages them.

A package of three modules stands for this one: a kernel, the kernel it calls and the constant it
adds, each in a module of its own.
"""

import os
import re
import shutil
import stat
import subprocess
import sys
from pathlib import Path

import pytest
from ensembles import ensemble

import roughcontact

PACKAGE = Path(roughcontact.__file__).parent

SOURCES = {
    "__init__": "",
    "constants": "OFFSET = 1.0\n",
    "unrelated": "OTHER = 1.0\n",
    "callee": (
        "from .kernel_cache import njit\n\n\n"
        "@njit(cache=True)\ndef scaled(x):\n    return 2.0 * x\n"
    ),
    "caller": (
        "from .callee import scaled\nfrom .constants import OFFSET\n"
        "from .kernel_cache import njit\n\n\n"
        "@njit(cache=True)\ndef result(x):\n    return scaled(x) + OFFSET\n"
    ),
}
#: Prints the result, and whether it was compiled (0) or found (1).
RUN = "from rocks.caller import result; print(result(10.0), sum(result.stats.cache_hits.values()))"


def without_notice(errors):
    """Standard error without the line that the first compilation of a process writes."""
    lines = errors.splitlines(keepends=True)
    return "".join(line for line in lines if not line.startswith("compiling kernels for this"))


class Project:
    """The package in a folder, and processes that use it."""

    def __init__(self, folder):
        self.folder, self.package = folder, folder / "rocks"
        self.package.mkdir()
        for name, text in SOURCES.items():
            self.write(name, text)
        for name in ("kernel_cache", "kernel_digest"):
            shutil.copy(PACKAGE / f"{name}.py", self.package)
        self.environment = {
            "PATH": os.environ["PATH"],
            "HOME": str(folder / "home"),
            "TMPDIR": str(folder),
            # Python's own files know the time of a change to the second only.
            "PYTHONDONTWRITEBYTECODE": "1",
        }

    def write(self, name, text):
        (self.package / f"{name}.py").write_text(text)

    def replace(self, name, old, new):
        self.write(name, SOURCES[name].replace(old, new))

    def start(self, code=RUN, **environment):
        return subprocess.Popen(
            [sys.executable, "-c", code],
            cwd=self.folder,
            env=self.environment | {key: str(value) for key, value in environment.items()},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )

    def run(self, code=RUN, **environment):
        """What a process prints, and what it says besides that it compiles."""
        process = self.start(code, **environment)
        output, errors = process.communicate()
        assert process.returncode == 0, errors
        return output.strip(), without_notice(errors)

    def no_cache_in_package(self):
        """Make the package one that cannot be written to, for root as well."""
        (self.package / "__pycache__").write_text("")

    @property
    def kernels(self):
        return self.package / "__pycache__/kernels"

    def files(self, folder=None):
        return sorted((folder or self.kernels).rglob("*.nbc"))


@pytest.fixture
def project(tmp_path):
    return Project(tmp_path)


@pytest.fixture(scope="module")
def original(tmp_path_factory):
    project = Project(tmp_path_factory.mktemp("original"))
    assert project.run() == ("21.0 0", "")
    return project


@pytest.fixture
def compiled(project, original):
    """One whose kernels are compiled already, elsewhere: they may move."""
    shutil.copytree(original.kernels, project.kernels)
    return project


def test_a_kernel_is_compiled_once_wherever_the_package_lies(compiled):
    assert compiled.run() == ("21.0 1", "")


def test_an_edited_callee_and_an_edited_constant_give_new_results(compiled):
    compiled.replace("callee", "2.0", "3.0")
    assert compiled.run() == ("31.0 0", "")
    compiled.replace("constants", "1.0", "5.0")
    assert compiled.run() == ("35.0 0", "")
    # Back again, as from one branch to another: compiled already.
    compiled.replace("constants", "1.0", "1.0")
    assert compiled.run() == ("31.0 1", "")


def test_an_edit_that_no_kernel_follows_from_compiles_nothing(compiled):
    compiled.replace("unrelated", "1.0", "2.0")
    assert compiled.run() == ("21.0 1", "")
    # The callee does not follow from its caller.
    compiled.replace("caller", "+ OFFSET", "- OFFSET")
    code = f"{RUN}; from rocks.callee import scaled; scaled(1.0); print(scaled.stats.cache_hits)"
    output, _ = compiled.run(code)
    assert output.splitlines()[0] == "19.0 0"
    assert "float64" in output.splitlines()[1]


def test_a_process_that_an_edit_overtakes_spoils_nothing(project):
    edit = "from pathlib import Path; Path('rocks/constants.py').write_text('OFFSET = 5.0')"
    code = f"import rocks.kernel_cache, rocks.constants; {edit}; {RUN}"
    assert project.run(code) == ("21.0 0", "")
    assert project.run() == ("25.0 0", "")
    assert project.run() == ("25.0 1", "")


def _flipped(content, place):
    return content[:place] + bytes([content[place] ^ 1]) + content[place + 1 :]


def test_damaged_files_are_replaced_in_silence(compiled):
    kinds = {
        "cut in half": lambda content: content[: len(content) // 2],
        "cut in its checksum": lambda content: content[:10],
        "emptied": lambda content: b"",
        "one bit": lambda content: _flipped(content, len(content) // 2),
        "one bit of its checksum": lambda content: _flipped(content, 0),
        "a byte more": lambda content: content + b"\n",
        "text": lambda content: b"<html>not found</html>\n",
        "zeros": lambda content: bytes(len(content)),
    }
    files = compiled.files()
    for kind in ensemble("damages to kernels") or kinds:
        damage = kinds[kind]
        for path in files:
            path.write_bytes(damage(path.read_bytes()))
        assert compiled.run() == ("21.0 0", ""), kind
        assert compiled.files() == files
    assert compiled.run() == ("21.0 1", "")


def test_a_whole_file_of_another_kernel_is_not_taken_for_this_one(compiled):
    (caller,) = (path for path in compiled.files() if "caller" in str(path))
    (callee,) = (path for path in compiled.files() if "callee" in str(path))
    shutil.copy(callee, caller)
    assert compiled.run() == ("21.0 0", "")
    assert compiled.run() == ("21.0 1", "")


def test_processes_that_compile_at_once_agree(project):
    calls = ("result(10.0)", "result(10)", "result(True) + 18", "result(np.float32(10))")
    turns = [calls[k % 4 :] + calls[: k % 4] for k in range(ensemble("processes that compile"))]
    code = "import numpy as np; from rocks.caller import result; print({{{}}})"
    processes = [project.start(code.format(", ".join(turn))) for turn in turns]
    for process in processes:
        output, errors = process.communicate()
        assert (output, without_notice(errors)) == ("{21.0}\n", "")
        assert process.returncode == 0
    hits = f"{code.format(', '.join(calls))}; print(len(result.stats.cache_hits))"
    assert project.run(hits) == ("{21.0}\n4", "")
    assert all(path.suffix == ".nbc" for path in project.kernels.rglob("*") if path.is_file())


def test_only_the_newest_versions_of_a_kernel_are_kept(project):
    """Twelve files of it; of other kernels all."""
    project.kernels.mkdir(parents=True)
    for age in range(20):
        for stem in ("rocks.caller.result", "rocks.other.result"):
            path = project.kernels / f"{stem}-{age:016x}-{age:016x}.nbc"
            path.write_text("")
            os.utime(path, (1e9 - age, 1e9 - age))
    assert project.run() == ("21.0 0", "")
    left = [path.name for path in project.files() if path.name.startswith("rocks.caller.result-")]
    assert len(left) == 12
    assert sum(f"{age:016x}-" in name for name in left for age in range(11)) == 11
    assert len([path for path in project.files() if "other" in path.name]) == 20
    assert project.run() == ("21.0 1", "")


def test_an_option_a_default_and_a_closed_over_number_give_new_results(project):
    """And so does an operator of a type, which no instruction of the kernel names."""
    project.write(
        "maker",
        "from .kernel_cache import njit\n\nCOUNT = (1, 2)\n\n\n"
        "def made(number):\n    @njit(cache=True)\n    def add(x, y=SHIFT):\n"
        "        return x + y + number + len(COUNT)\n\n    return add\n",
    )
    text = (project.package / "maker.py").read_text()
    run = "from rocks.maker import made; f = made({}); print(f(1.0), len(f.stats.cache_hits))"
    for shift, number, expected in ((1, 2, "6.0 0"), (2, 2, "7.0 0"), (2, 5, "10.0 0")):
        project.write("maker", text.replace("SHIFT", str(shift)))
        assert project.run(run.format(number)) == (expected, "")
    project.write(
        "maker", text.replace("SHIFT", "2").replace("cache=True", "cache=True, fastmath=True")
    )
    assert project.run(run.format(5)) == ("10.0 0", "")


@pytest.mark.full
def test_a_process_outlives_the_removal_of_its_kernels(project):
    remove = "import shutil; shutil.rmtree('rocks/__pycache__/kernels')"
    assert project.run(f"{RUN}; {remove}; print(result(10))") == ("21.0 0\n21.0", "")
    assert project.run(RUN.replace("10.0", "10")) == ("21.0 1", "")


def test_the_folder_that_the_user_names_is_used(project):
    named = project.folder / "named"
    assert project.run(NUMBA_CACHE_DIR=named) == ("21.0 0", "")
    assert project.run(NUMBA_CACHE_DIR=named) == ("21.0 1", "")
    (folder,) = named.iterdir()
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    assert project.files(folder)
    assert not project.kernels.exists()


@pytest.mark.full
def test_a_package_that_cannot_be_written_to_uses_the_user_s_folder(project):
    project.no_cache_in_package()
    for environment, folder in (
        ({}, project.folder / "home/.cache/roughcontact"),
        ({"XDG_CACHE_HOME": project.folder / "xdg"}, project.folder / "xdg/roughcontact"),
    ):
        assert project.run(**environment) == ("21.0 0", "")
        assert project.run(**environment) == ("21.0 1", "")
        assert stat.S_IMODE(folder.stat().st_mode) == 0o700
        assert project.files(folder)


NOWHERE = {"HOME": "/proc/nowhere"}


def test_a_read_only_package_says_where_its_kernels_are(project):
    project.no_cache_in_package()
    folder = project.folder / "home/.cache/roughcontact"
    code = f"{RUN}; from rocks.kernel_cache import cache_folder; print(cache_folder())"
    output, errors = project.start(code).communicate()
    assert output == f"21.0 0\n{folder}\n"
    assert errors.startswith("compiling kernels for this processor, once")
    assert str(folder) in errors


def test_without_a_home_the_kernels_go_to_a_private_temporary_folder(project):
    project.no_cache_in_package()
    assert project.run(**NOWHERE) == ("21.0 0", "")
    assert project.run(**NOWHERE) == ("21.0 1", "")
    folder = project.folder / f"roughcontact-{os.geteuid()}"
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    assert project.files(folder)


@pytest.mark.full
def test_without_any_folder_kernels_work_and_one_sentence_says_so(project):
    project.no_cache_in_package()
    (project.folder / f"roughcontact-{os.geteuid()}").write_text("")
    for _ in range(2):
        output, errors = project.run(f"{RUN}; print(result(10))", **NOWHERE)
        assert output == "21.0 0\n21.0"
        assert errors.count("Warning") == 1
        assert "compiled kernels cannot be kept" in errors
        assert f"neither {project.kernels} nor /proc/nowhere/.cache/roughcontact nor" in errors
        assert "set NUMBA_CACHE_DIR" in errors


def _open_to_all(folder):
    folder.chmod(0o777)


def _open_to_the_group(folder):
    folder.chmod(0o770)


def _of_somebody_else(folder):
    if os.geteuid() != 0:
        pytest.skip("only root gives a folder away")
    os.chown(folder, 65534, 65534)


def _a_link(folder):
    folder.rename(folder.with_name("real"))
    folder.symlink_to("real")


@pytest.mark.parametrize(
    "spoil",
    [
        _open_to_all,
        *(
            pytest.param(spoil, marks=pytest.mark.full)
            for spoil in (_open_to_the_group, _of_somebody_else, _a_link)
        ),
    ],
    ids=lambda f: f.__name__,
)
def test_nothing_is_loaded_from_a_folder_that_others_can_write_to(project, original, spoil):
    project.no_cache_in_package()
    folder = project.folder / f"roughcontact-{os.geteuid()}"
    shutil.copytree(original.kernels, folder)
    folder.chmod(0o700)
    before = [path.read_bytes() for path in project.files(folder)]
    spoil(folder)
    output, errors = project.run(**NOWHERE)
    assert output == "21.0 0"
    assert "cannot be kept" in errors
    assert [path.read_bytes() for path in project.files(folder.resolve())] == before


def test_a_named_folder_that_others_can_write_to_is_refused_aloud(project):
    folder = project.folder / "named/roughcontact-kernels"
    folder.mkdir(parents=True)
    folder.chmod(0o777)
    output, errors = project.run(NUMBA_CACHE_DIR=folder.parent)
    assert output == "21.0 0"
    assert errors.count("Warning") == 1
    assert f"{folder}: not a private folder of this user" in errors
    assert project.run(NUMBA_CACHE_DIR=folder.parent)[0] == "21.0 1"
    assert not project.files(folder)


def test_who_may_only_read_the_package_uses_what_came_with_it(compiled):
    (compiled.folder / f"roughcontact-{os.geteuid()}").write_text("")
    read_only = "import os; os.access = lambda *args: False"
    assert compiled.run(f"{read_only}; {RUN}", **NOWHERE) == ("21.0 1", "")


def test_a_full_disk_stops_nothing_and_one_sentence_says_so(project):
    limit = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))"
    output, errors = project.run(f"{limit}; {RUN}; print(result(10))")
    assert output == "21.0 0\n21.0"
    assert errors.count("Warning") == 1
    assert str(project.kernels) in errors
    assert "compiled kernels cannot be kept" in errors
    assert [path for path in project.kernels.rglob("*") if path.is_file()] == []
    assert project.run() == ("21.0 0", "")


def test_kernels_work_without_the_compiler_too(project):
    code = "from rocks.caller import result; print(result(10.0), type(result).__name__)"
    assert project.run(code, NUMBA_DISABLE_JIT=1) == ("21.0 function", "")
    assert not project.kernels.exists()


@pytest.mark.full
def test_kernels_that_check_bounds_are_others(compiled):
    assert compiled.run(NUMBA_BOUNDSCHECK=1) == ("21.0 0", "")
    assert compiled.run() == ("21.0 1", "")


def test_a_kernel_compiled_again_on_request_forgets_the_old_one(compiled):
    code = f"{RUN}; result.recompile(); print(sum(result.stats.cache_hits.values()))"
    assert compiled.run(code) == ("21.0 1\n1", "")
    assert compiled.run() == ("21.0 1", "")


def test_kernels_of_other_packages_keep_the_cache_that_numba_gives_them(project):
    (project.folder / "other.py").write_text(
        "import numba\n\n\n@numba.njit(cache=True)\ndef f(x):\n    return x\n"
    )
    code = f"{RUN}; import other, numba; other.f(1); print(repr(numba.config.CACHE_DIR))"
    assert project.run(code) == ("21.0 0\n''", "")
    assert sorted(path.suffix for path in (project.folder / "__pycache__").iterdir()) == [
        ".nbc",
        ".nbi",
    ]


def test_every_kernel_of_the_package_is_kept_in_this_way():
    """None takes ``njit`` from numba itself."""
    direct = re.compile(r"^\s*from numba import .*jit|\bnumba\.n?jit\(|@numba\.", re.MULTILINE)
    found = [path.name for path in PACKAGE.rglob("*.py") if direct.search(path.read_text())]
    assert found == ["kernel_cache.py"]
