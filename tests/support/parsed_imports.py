"""Files that a module imports, as the parser of Python finds them."""

import ast
from functools import cache


def module_in(folder, name):
    """The file of a module in a folder, in a list that may be empty."""
    files = [folder / name / "__init__.py", folder / f"{name}.py"]
    return [file for file in files if file.is_file()][:1]


@cache
def parsed_imports(path, package):
    """Files that the import statements of one file name, and those of folders that it lists."""
    found = []
    nodes = list(ast.walk(ast.parse(path.read_text(encoding="utf-8"))))
    listed = {
        ast.unparse(node.args[0])
        for node in nodes
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "modules_of"
    }
    if "sys.modules[__package__]" in listed:
        found += sorted(path.parent.glob("*.py"))
    for node in nodes:
        if isinstance(node, ast.ImportFrom):
            parts = (node.module or "").split(".") if node.module else []
            chains = [(node.level, parts, [alias.name for alias in node.names])]
        elif isinstance(node, ast.Import):
            chains = [(0, alias.name.split("."), []) for alias in node.names]
        else:
            continue
        for level, parts, names in chains:
            if level:
                folder = path.parents[level - 1]
            elif parts[0] == package.name:
                folder = package.parent
            elif (path.parent / "__init__.py").exists():
                continue
            else:
                folder = path.parent
            if not level and not module_in(folder, parts[0]):
                continue
            for part in parts:
                found += module_in(folder, part)
                folder /= part
            if (folder / "__init__.py").exists():
                for name in names:
                    found += module_in(folder, name)
                    if name in listed:
                        found += sorted((folder / name).glob("*.py"))
    return found


def parsed_files(path, package):
    seen, queue = set(), [path]
    while queue:
        path = queue.pop()
        if path not in seen:
            seen.add(path)
            queue += parsed_imports(path, package)
            for folder in path.parents:
                if not (folder / "__init__.py").exists():
                    break
                queue.append(folder / "__init__.py")
    return sorted(seen)
