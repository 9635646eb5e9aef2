"""The checker of annotations sees what is public, and nothing else."""

from annotations import check, main

SOURCE = """
def complete(a: int, /, *b: int, c: int = 0, **d: int) -> None: ...
def bare(a, /, b: int, *c, d=0, **e): ...
def _private(a): ...

if True:
    def conditional(a: int): ...

class Public:
    def __init__(self, a): ...
    def __repr__(self): ...
    def method(self, a: int) -> int:
        def inner(b): ...
    @property
    def value(self): ...
    @staticmethod
    def static(a) -> int: ...
    @classmethod
    def made(cls, a: int) -> int: ...
    def _private(self, a): ...

class _Private:
    def method(self, a): ...
"""


def test_public_functions_without_annotations_are_listed(tmp_path):
    path = tmp_path / "module.py"
    path.write_text(SOURCE)
    assert check(path) == [
        f"{path}:3: bare: no annotation of a, d, c, e, return",
        f"{path}:7: conditional: no annotation of return",
        f"{path}:10: Public.__init__: no annotation of a",
        f"{path}:15: Public.value: no annotation of return",
        f"{path}:17: Public.static: no annotation of a",
    ]
    assert main([str(tmp_path)]) == 1


def test_a_complete_file_passes_and_an_empty_folder_does_not(tmp_path):
    assert main([str(tmp_path)]) == 1  # a mistyped folder is no success
    (tmp_path / "module.py").write_text("def f(a: int) -> int: ...\n")
    assert main([str(tmp_path)]) == 0
