"""Header lines of any length cost nothing: they are cut before a pattern is applied."""

import pytest

from fractalcontact.core.errors import InputError
from fractalcontact.scan.read import read_scan

ROWS = "".join(f"{i} {i + 1} {i * i} {i + 2} {i} {i} {i} {i} {i}\n" for i in range(20))
HOSTILE = [
    "# spacing " + "1" * 60_000,
    "# spacing " + "1.5e" * 15_000,
    "nodata" + " " * 200_000 + "x",
    "# " + "unit " * 12_000,
    "# " + "origin first row " * 4_000,
    "#" + " " * 200_000 + "x",
    "x" + " " * 60_000 + "[",
    "x [mm], y [mm], z [" + " " * 60_000,
    "void " + "1 " * 30_000 + "x",
]


@pytest.mark.parametrize("line", HOSTILE, ids=lambda line: f"{line[:12].strip()}")
def test_a_long_header_line_is_no_hostile_file(tmp_path, line):
    path = tmp_path / "rock.txt"
    path.write_text(f"{line}\n" * 3 + ROWS)
    with pytest.raises(InputError, match=r"rock\.txt") as error:
        read_scan(path)
    assert "hostile" not in str(error.value)
    assert "kind:" in error.value.draft
