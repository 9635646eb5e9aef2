"""Text is read and written in an encoding that the code states, never in that of the locale."""

import ast

import pytest
from places import ROOT

#: Folders whose modules read and write text of their own.
FOLDERS = ("src", "workflow", "benchmarks", "tests/support")
#: Where the mode of a call stands among its arguments.
MODES = {"open": 1, ".open": 0, "fdopen": 1, "NamedTemporaryFile": 0, "TemporaryFile": 0}
#: Calls of these names that open no text: descriptors, members of archives, pictures.
OTHERS = {"os.open", "archive.open", "Image.open"}


def unstated(source):
    """Lines of calls that read or write text in the encoding of the locale."""
    calls = (node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Call))
    return [call.lineno for call in calls if _depends_on_locale(call)]


def _depends_on_locale(call):
    words = {word.arg: word.value for word in call.keywords}
    called = ast.unparse(call.func)
    name = called.rpartition(".")[2]
    if "encoding" in words or None in words or called in OTHERS:
        return False
    if name in ("read_text", "write_text", "TextIOWrapper"):
        return len(call.args) < (1 if name == "read_text" else 2)
    if name in ("run", "Popen", "check_output"):
        return bool({"text", "universal_newlines"} & set(words))
    at = MODES.get(".open" if name == "open" and "." in called else name)
    if at is None:
        return False
    mode = words.get("mode", call.args[at] if len(call.args) > at else None)
    return not (isinstance(mode, ast.Constant) and "b" in str(mode.value))


@pytest.mark.parametrize("folder", FOLDERS)
def test_text_is_read_and_written_in_a_stated_encoding(folder):
    paths = sorted((ROOT / folder).rglob("*.py"))
    assert paths
    found = {
        str(path.relative_to(ROOT)): lines
        for path in paths
        if (lines := unstated(path.read_text(encoding="utf-8")))
    }
    assert not found


@pytest.mark.parametrize(
    ("line", "depends"),
    [
        ("path.read_text()", True),
        ("path.read_text('utf-8')", False),
        ("path.write_text(text)", True),
        ("path.write_text(text, 'utf-8')", False),
        ("open(path)", True),
        ("open(path, 'rb')", False),
        ("path.open('w', newline='')", True),
        ("path.open(mode='wb')", False),
        ("open(path, encoding='utf-8')", False),
        ("os.open(path, os.O_RDONLY)", False),
        ("subprocess.run(command, text=True)", True),
        ("subprocess.run(command, text=True, encoding='utf-8')", False),
        ("subprocess.run(command, capture_output=True)", False),
    ],
)
def test_calls_that_depend_on_the_locale_are_found(line, depends):
    assert unstated(line) == [1] * depends
