"""Memory that the job of a specimen asks for."""

import os

from fractalcontact.study.memory import LEAST, specimen_memory


def sized(path, size):
    path.touch()
    os.truncate(path, size)  # a file with nothing in it takes no room
    return path


def test_a_small_scan_asks_for_what_every_job_takes(tmp_path):
    assert specimen_memory([sized(tmp_path / "rock.npy", 10**6)]) == LEAST
    assert specimen_memory([tmp_path / "absent.npy"]) == LEAST


def test_more_is_asked_for_large_files_and_for_two_faces(tmp_path):
    text = sized(tmp_path / "rock.xyz", 315 * 10**6)
    assert 2700 <= specimen_memory([text]) <= 3500
    other = sized(tmp_path / "other.XYZ", 315 * 10**6)
    assert specimen_memory([text, other]) > 1.7 * specimen_memory([text])
    # Packed heights unfold to many times the file.
    assert specimen_memory([sized(tmp_path / "rock.x3p", 10**8)]) > 5000
