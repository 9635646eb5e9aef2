"""A short part of the fuzzing with a fixed seed; `make fuzz FILES=5000` is the whole."""

import fuzzing
import numpy as np
import pytest
from ensembles import ensemble
from mutations import ANY, TEXT_ONLY

from fractalcontact.core.errors import InputError


@pytest.mark.parametrize("mutation", [*ANY, *TEXT_ONLY], ids=lambda mutation: mutation.__name__)
def test_mutations_depend_on_their_seed_alone_and_do_change_something(mutation):
    content = b"size 12 15\n" + bytes(range(256)) * 4
    results = [mutation(content, np.random.default_rng(n)) for n in range(20)]
    assert results == [mutation(content, np.random.default_rng(n)) for n in range(20)]
    assert any(result != content for result in results)


SOUND = [f".{kind}" for kind in ensemble("sound scan files") or ()] or list(fuzzing.WRITERS)


def test_the_judge_sees_what_must_not_happen(monkeypatch):
    """Sound files are read; each kind of misbehaviour is a fault."""

    def misbehave(path, chosen):
        match chosen.ending:
            case ".bug":
                raise KeyError("a bug")
            case ".nameless":
                raise InputError("something is wrong")
            case ".long":
                raise InputError(f"{path}: {'x' * 2000}")
            case ".writes":
                (path.parent / "other").write_text("more")
            case ".eats":
                np.ones(fuzzing.MAX_MEMORY // 4)

    with fuzzing.own_folder() as folder:
        for seed in fuzzing.make_seeds(folder / "temporary", real=False):
            if seed.ending in SOUND:
                assert fuzzing.judge(seed, seed.content, folder).was_read
        monkeypatch.setattr(fuzzing, "_read", misbehave)
        monkeypatch.setattr(fuzzing, "MAX_MEMORY", 5 * 10**7)
        for ending, fault in {
            ".bug": "KeyError",
            ".nameless": "does not name the file",
            ".long": "a message of 20",
            ".writes": "files created",
            ".eats": "GiB",
        }.items():
            verdict = fuzzing.judge(fuzzing.Seed(ending, b"1 2 3", {}), b"1 2 3", folder)
            assert fault in verdict.fault


def test_spoilt_files_are_read_or_refused():
    files = ensemble("spoilt scan files")
    verdicts = fuzzing.run(range(files), seed=1, real=False)
    assert [verdict for verdict in verdicts if verdict.fault] == []
    assert 0.04 * files < sum(verdict.was_read for verdict in verdicts) < 0.9 * files
    assert {verdict.ending for verdict in verdicts} >= {*fuzzing.WRITERS, ".yaml"}
