"""Every file that is not as it was made is noticed; what is, is read."""

import os
import shutil
import subprocess
import time

import pytest

from fractalcontact.commands.verify import main as verify
from fractalcontact.core.checksums import (
    Digests,
    check,
    lines_of,
    record,
    require_intact,
    set_aside,
    sha256,
)
from fractalcontact.core.errors import InputError


@pytest.fixture
def results(tmp_path):
    """A study's folder with a stage of two specimens, a figure and an embedded scan."""
    files = {
        "closure/a.nc": b"closure of a" * 50,
        "closure/a.b.nc": b"closure of a.b" * 50,
        "figures/a/fig1.png": b"picture" * 50,
        "figures/a/fig1.csv": b"x,y\n1,2\n" * 9,
        "embedded/a.npy": b"heights" * 50,
        "embedded/a.yaml": b"unit: mm\n",
        "atlas.nc": b"atlas" * 50,
    }
    for name, content in files.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    record(tmp_path, [tmp_path / name for name in files])
    return tmp_path


DAMAGES = {
    "truncated": lambda content: content[:-7],
    "emptied": lambda content: b"",
    "one bit": lambda content: content[:3] + bytes([content[3] ^ 1]) + content[4:],
    "text": lambda content: b"<html>404</html>",
}


def test_what_is_intact_is_read(results):
    checked = check(results)
    assert len(checked.intact) == 7
    assert checked.damaged == checked.missing == []
    for path in checked.intact:
        require_intact(results, path)


@pytest.mark.parametrize("keep_times", [False, True])
@pytest.mark.parametrize("how", DAMAGES)
@pytest.mark.parametrize("name", ["closure/a.nc", "figures/a/fig1.csv", "embedded/a.yaml"])
def test_damage_is_noticed_whatever_the_times_say(results, tmp_path, name, how, keep_times):
    digests = Digests(tmp_path / "cache.json")
    check(results, digests.of)
    path = results / name
    times = path.stat().st_atime_ns, path.stat().st_mtime_ns
    path.write_bytes(DAMAGES[how](path.read_bytes()))
    if keep_times:
        os.utime(path, ns=times)
    assert check(results).damaged == check(results, digests.of).damaged == [path]
    with pytest.raises(InputError, match=f"{name}: damaged or replaced after it was made"):
        require_intact(results, path)


@pytest.mark.parametrize("how", DAMAGES)
def test_a_damaged_record_counts_as_damage_of_its_files(results, how):
    path = results / "checksums/figures/a/fig1.sha256"
    path.write_bytes(DAMAGES[how](path.read_bytes()))
    damaged = check(results).damaged
    figures = {results / "figures/a/fig1.png", results / "figures/a/fig1.csv"}
    if how == "one bit":  # of one of the checksums
        assert len(figures & set(damaged)) == 1
    else:
        assert set(damaged) == {path, *figures}
    assert not {results / "closure/a.nc", results / "atlas.nc"} & set(damaged)


def test_a_file_without_a_record_is_not_read(results):
    stray = results / "closure/stray.nc"
    stray.write_bytes(b"from elsewhere")
    with pytest.raises(InputError, match=r"stray\.nc: the record of its making is missing"):
        require_intact(results, stray)
    assert check(results).unrecorded == [stray]
    assert verify([str(results)]) == 1


def test_without_any_record_nothing_passes_for_intact(results, capsys):
    shutil.rmtree(results / "checksums")
    assert verify([str(results)]) == 1
    checked = check(results)
    assert checked.intact == []
    assert {path.name for path in checked.unrecorded} == {"a.nc", "a.b.nc", "a.npy", "atlas.nc"}


def test_files_of_others_are_left_alone_and_damaged_ones_kept(results):
    """A record that is damaged says nothing of a user's own file beside those of the study."""
    own = results / "atlas.xlsx"
    own.write_text("my table")
    (results / "checksums/atlas.sha256").write_text("")
    damaged = check(results).damaged
    assert results / "atlas.nc" in damaged
    assert own not in damaged
    content = (results / "atlas.nc").read_bytes()
    aside = set_aside(results, results / "atlas.nc")
    assert aside == results / "damaged/atlas.nc"
    assert aside.read_bytes() == content
    assert aside not in check(results).unrecorded


def test_a_record_cannot_lead_out_of_the_results(results, tmp_path):
    secret = tmp_path.parent / "secret"
    secret.write_text("x")
    line = f"{sha256(secret)}  ../secret\n"
    (results / "checksums/atlas.sha256").write_text(line)
    assert secret not in check(results).intact + check(results).damaged


def test_the_manifest_is_what_sha256sum_takes(results):
    (results / "manifest.sha256").write_text("".join(lines_of(results)))
    command = ["sha256sum", "--check", "--strict", "manifest.sha256"]
    english = os.environ | {"LC_ALL": "C"}  # sha256sum says "Tamam" to a Turk
    done = subprocess.run(command, cwd=results, capture_output=True, text=True, env=english)
    assert done.returncode == 0
    assert done.stdout.count(": OK") == 7


def test_a_file_replaced_by_an_older_one_of_the_same_size_is_another(tmp_path):
    """mv, cp -p, rsync -a, unzip and git keep or set times; the cache does not go by them."""
    first, second = tmp_path / "scan.npy", tmp_path / "other"
    first.write_bytes(b"a" * 100)
    second.write_bytes(b"b" * 100)
    long_ago = time.time() - 1e6
    for path in (first, second):
        os.utime(path, (long_ago, long_ago))
    cache = tmp_path / "cache.json"
    time.sleep(2.1)  # only what has not changed for two seconds is kept
    digests = Digests(cache)
    before = digests.of(first)
    digests.save()
    os.replace(second, first)
    assert Digests(cache).of(first) == sha256(first) != before


def test_a_file_changed_a_moment_ago_is_not_taken_from_the_cache(tmp_path):
    path, cache = tmp_path / "x", tmp_path / "cache.json"
    path.write_bytes(b"a")
    digests = Digests(cache)
    digests.of(path)
    digests.save()
    assert not cache.exists()


def test_a_damaged_cache_is_made_anew(tmp_path):
    path, cache = tmp_path / "x", tmp_path / "cache.json"
    path.write_bytes(b"a")
    time.sleep(2.1)
    digests = Digests(cache)
    digests.of(path)
    digests.save()
    kept = cache.read_text()
    wrong = kept.replace(sha256(path), sha256(path)[::-1])
    assert wrong != kept
    for content in ("", "[1]", '{"half', "null", wrong, kept[:-4]):
        cache.write_text(content)
        assert Digests(cache).of(path) == sha256(path)


def test_verify_tells_what_is_damaged_and_missing(results, capsys):
    assert verify([str(results)]) == 0
    (results / "atlas.nc").write_bytes(b"half")
    (results / "figures/a/fig1.csv").unlink()
    assert verify([str(results)]) == 1
    said = capsys.readouterr().out
    assert f"damaged: {results}/atlas.nc" in said
    assert f"missing: {results}/figures/a/fig1.csv" in said
    assert "5 intact, 1 damaged, 0 unrecorded, 1 missing" in said
