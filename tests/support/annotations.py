"""Checker of ``make lint``: every public function and method of the package is annotated.

    python tests/support/annotations.py src/fractalcontact

prints ``file:line: name: what is missing`` and ends with 1 if anything is. mypy then checks what is
annotated; of a function without annotations it would say nothing.
"""

import ast
import sys
from collections.abc import Iterator
from pathlib import Path

Function = ast.FunctionDef | ast.AsyncFunctionDef


def public_functions(tree: ast.Module) -> Iterator[tuple[str, Function, bool]]:
    """Name, definition and whether its first parameter is ``self`` or ``cls``, of what is public.

    Those of a module and of its public classes whose name has no leading underscore, and the
    ``__init__`` of a public class, which is how it is called. Functions inside functions are not.
    """
    yield from _functions(tree.body, "", in_class=False)


def _functions(body: list[ast.stmt], prefix: str, in_class: bool) -> Iterator:
    for node in body:
        if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
            yield from _functions(node.body, f"{prefix}{node.name}.", in_class=True)
        elif isinstance(node, Function):
            if not node.name.startswith("_") or (in_class and node.name == "__init__"):
                decorators = {d.id for d in node.decorator_list if isinstance(d, ast.Name)}
                yield prefix + node.name, node, in_class and "staticmethod" not in decorators
        elif isinstance(node, ast.If | ast.Try | ast.With):  # defined under a condition
            parts = (getattr(node, part, []) for part in ("body", "orelse", "finalbody"))
            yield from _functions([child for part in parts for child in part], prefix, in_class)


def missing_annotations(function: Function, bound: bool) -> list[str]:
    """Parameters without an annotation, and "return" where the result has none.

    Parameters
    ----------
    function : ast.FunctionDef or ast.AsyncFunctionDef
    bound : bool
        Whether the first parameter is ``self`` or ``cls``, which needs none.
    """
    given = function.args
    named = [*given.posonlyargs, *given.args][bound:] + given.kwonlyargs
    rest = [arg for arg in (given.vararg, given.kwarg) if arg]
    missing = [arg.arg for arg in named + rest if arg.annotation is None]
    # As for mypy, an __init__ need not say that it returns nothing.
    if function.returns is None and function.name != "__init__":
        missing.append("return")
    return missing


def check(path: Path) -> list[str]:
    """One line for each public function of a file that lacks annotations."""
    tree = ast.parse(path.read_text(encoding="utf-8"), str(path))
    return [
        f"{path}:{function.lineno}: {name}: no annotation of {', '.join(missing)}"
        for name, function, bound in public_functions(tree)
        if (missing := missing_annotations(function, bound))
    ]


def main(paths: list[str]) -> int:
    """Print what is missing in files and folders; 1 if anything is, else 0."""
    files = [
        file
        for path in map(Path, paths)
        for file in ([path] if path.is_file() else sorted(path.rglob("*.py")))
    ]
    if not files:
        print(f"no Python files in {', '.join(paths)}")
        return 1
    lines = [line for file in files for line in check(file)]
    print(*lines, sep="\n", end="\n" * bool(lines))
    print(f"{len(lines)} public functions lack annotations" if lines else "all annotated")
    return int(bool(lines))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
