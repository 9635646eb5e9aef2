"""Which variables of an atlas some module names that does not make them.

A name is read where it stands as a string, in the register, a template or a script of a page. The
key of a dictionary, a keyword and what is assigned to by a name make it, but in rooms that only
read. An f-string reads what fits it; one that is nothing but an ending, such as ``f"{name}_low"``,
reads nothing.
"""

import ast
import re
from functools import cache

from projects import ROOT

#: Rooms of the chain whose modules make no variable, and the module that reads what it made.
_READERS = ("cards", "commands", "figures", "pages", "report", "reported.py")
#: Endings that belong to the estimate before them: it is read with them.
_ENDING = re.compile(
    r"_(low|high|error|half_width|n|min|max|b_min|b_max|r_min|r_max|mean|band|cut|random|difference"
    r"|reason|verdict|determined|deviation|fitted|total|total_of_population|hardest)$"
)
_ENDINGS = frozenset(_ENDING.pattern[2:-2].split("|"))


def unread(variables):
    """Those of some names of variables that nothing reads but what makes them, sorted."""
    named, patterns = _read()
    return sorted(
        name
        for name in variables
        if not name.startswith("no_")  # why there is no value
        and not any(
            one in named or any(pattern.fullmatch(one) for pattern in patterns)
            for one in _with_estimates(name)
        )
    )


def _with_estimates(name):
    yield name
    yield name.replace("_across", "_along")  # one function makes both
    while (shorter := _ENDING.sub("", name)) != name:
        name = shorter
        yield name


@cache
def _read():
    """Names that are read, and patterns of f-strings that read."""
    named, patterns = set(), set()
    for package in ("fractalcontact", "contactlab"):
        for path in (ROOT / "src" / package).rglob("*"):
            if path.suffix == ".py":
                reads = not {*path.parts}.isdisjoint(_READERS)
                texts, formats = _of_module(ast.parse(path.read_text(encoding="utf-8")), reads)
                named |= texts
                patterns |= formats
            elif path.name == "published.yaml":
                named |= {*re.findall(r"\w+/(\w+)", path.read_text(encoding="utf-8"))}
            elif path.suffix in (".jinja", ".html", ".js"):
                named |= {*re.findall(r"\w+", path.read_text(encoding="utf-8"))}
    return named, [re.compile(pattern) for pattern in patterns]


def _of_module(tree, reads):
    made = {id(key) for node in ast.walk(tree) if isinstance(node, ast.Dict) for key in node.keys}
    made |= {id(node.key) for node in ast.walk(tree) if isinstance(node, ast.DictComp)}
    made |= {
        id(node.slice)
        for node in ast.walk(tree)
        if isinstance(node, ast.Subscript) and isinstance(node.ctx, ast.Store)
    }
    texts, formats, making = set(), set(), set()
    for node in ast.walk(tree):
        if isinstance(node, ast.keyword):
            making.add(node.arg)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            # "STAGE/VARIABLE" names a variable too.
            (making if id(node) in made else texts).add(node.value.rpartition("/")[2])
        elif isinstance(node, ast.JoinedStr) and id(node) not in made:
            parts = [one.value if isinstance(one, ast.Constant) else None for one in node.values]
            words = {word for part in parts if part for word in part.split("_")} - _ENDINGS
            whole = all(re.fullmatch(r"\w+", part) for part in parts if part)
            if whole and any(len(word) > 2 for word in words):
                formats.add("".join(re.escape(part) if part else r"\w+" for part in parts))
    return texts | making if reads else texts - making, formats
