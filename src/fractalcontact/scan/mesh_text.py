"""Text of mesh files: headers of PLY, numbers of ASCII PLY, OBJ and STL, and their counts."""

import io
import re
from collections.abc import Sequence
from pathlib import Path
from typing import BinaryIO, NamedTuple

import numpy as np

from ..core.errors import InputError
from .text_lines import notes_on_end

_TYPES = {
    **dict.fromkeys(("char", "int8"), "i1"),
    **dict.fromkeys(("uchar", "uint8"), "u1"),
    **dict.fromkeys(("short", "int16"), "i2"),
    **dict.fromkeys(("ushort", "uint16"), "u2"),
    **dict.fromkeys(("int", "int32"), "i4"),
    **dict.fromkeys(("uint", "uint32"), "u4"),
    **dict.fromkeys(("float", "float32"), "f4"),
    **dict.fromkeys(("double", "float64"), "f8"),
}
MAX_VERTICES = 2**31
#: Counts that programs write into the comments of OBJ.
_STATED = re.compile(
    r"#\s*(?:(?P<n>\d{1,12})\s+(?P<what>vertices|faces)|(?P<named>vertices|faces):\s*(?P<m>\d{1,12}))"
    r"\s*(?:,|$)",
    re.IGNORECASE,
)
_STL_LINE = re.compile(r"^[ \t]*(solid|endsolid|facet|endfacet|vertex)\b", re.IGNORECASE | re.M)
_STL_VERTEX = re.compile(
    r"^[ \t]*vertex(?:[ \t]+[-+\w.]+){3}[ \t\r]*$", re.IGNORECASE | re.MULTILINE
)


class MeshText(NamedTuple):
    """Vertices (n, 3) and triangles (m, 3) of a text, and notes on it."""

    vertices: np.ndarray
    triangles: np.ndarray
    notes: tuple[str, ...]


class Element(NamedTuple):
    """Element that the header of a PLY file declares, such as vertex or face."""

    name: str
    length: int
    properties: list[tuple[str, str, bool]]
    """Name, type and whether it is a list."""


class PlyHeader(NamedTuple):
    """Header of a PLY file."""

    is_ascii: bool
    elements: list[Element]
    lines: int
    content: bytes
    """The header without comments, its coordinates called x, y and z."""


def read_ply_header(stream: BinaryIO, path: Path) -> PlyHeader:
    """Header of a PLY file; the stream then stands behind it.

    Comments and ``obj_info`` may hold any word, ``end_header`` among them.
    """
    lines, count = [], 0
    for raw in stream:
        count += 1
        words = raw.decode("latin-1").split()
        if words == ["end_header"]:
            break
        if words and words[0] not in ("comment", "obj_info"):
            lines.append(words)
    else:
        raise InputError(f"{path}: its header has no line 'end_header'; export it again")
    elements: list[Element] = []
    for words in lines:
        if words[0] == "element" and len(words) == 3 and words[2].isdecimal():
            elements.append(Element(words[1], int(words[2]), []))
        elif words[0] == "property" and elements and len(words) in (3, 5):
            if not {*words[1:-1]} - {"list"} <= _TYPES.keys():
                raise InputError(f"{path}: its header has no known type in {' '.join(words)!r}")
            names = [name for name, _, _ in elements[-1].properties]
            lower = words[-1].lower()
            if elements[-1].name == "vertex" and lower in ("x", "y", "z") and lower not in names:
                words[-1] = lower
            elements[-1].properties.append((words[-1], words[-2], len(words) == 5))
    content = "\n".join(" ".join(words) for words in [*lines, ["end_header"]]) + "\n"
    is_ascii = len(lines) > 1 and "ascii" in lines[1]
    return PlyHeader(is_ascii, elements, count, content.encode("latin-1"))


def read_ascii_ply(stream: BinaryIO, header: PlyHeader, path: Path) -> MeshText:
    """Vertices and triangles of an ASCII PLY file, read behind its header.

    More or fewer lines than the header states, and a line of other numbers, are refused.
    """
    content = stream.read().decode("latin-1")
    lines = content.split("\n")
    rows = [(n, words) for n, line in enumerate(lines, header.lines + 1) if (words := line.split())]
    promised = sum(element.length for element in header.elements)
    if len(rows) != promised:
        counts = " and ".join(f"{element.length} x {element.name}" for element in header.elements)
        raise InputError(
            f"{path}: its header states {counts}, one a line, but {len(rows)} lines stand below "
            "it; the file is cut off or damaged, so export it again"
        )
    vertices, triangles = np.empty((0, 3)), np.empty((0, 3), np.int64)
    start, last = 0, rows
    for element in header.elements:
        part, start = rows[start : start + element.length], start + element.length
        last = part or last
        fields = [_fields(words, element, number, path) for number, words in part]
        if element.name == "vertex":
            vertices = _coordinates(fields, element, path)
        elif element.name == "face" and element.properties:
            triangles = _fan([_polygon(row, element) for row in fields])
    notes = notes_on_end([" ".join(words) for _, words in last], content, path)
    return MeshText(vertices, triangles, notes)


def _fields(words: list[str], element: Element, number: int, path: Path) -> list[list[float]]:
    """Numbers of a line by property."""
    try:
        numbers = [float(word) for word in words]
        fields, place = [], 0
        for _, _, is_list in element.properties:
            length, place = (int(numbers[place]), place + 1) if is_list else (1, place)
            fields.append(numbers[place : place + length])
            place += length
            if length < 0 or place > len(numbers):
                break
        if place == len(numbers) and len(fields) == len(element.properties):
            return fields
    except (ValueError, OverflowError, IndexError):
        pass
    raise InputError(
        f"{path}: line {number} holds {' '.join(words)[:60]!r}, not the numbers of one "
        f"{element.name} as its header states; the file is damaged, so export it again"
    )


def _coordinates(fields: list, element: Element, path: Path) -> np.ndarray:
    names = [name for name, _, is_list in element.properties if not is_list]
    if not {"x", "y", "z"} <= set(names) or len(names) < len(element.properties):
        raise InputError(
            f"{path}: its vertices have {', '.join(names)}; expected numbers x, y and z; export it "
            "again"
        )
    types = {name: _TYPES[kind] for name, kind, _ in element.properties}
    table = np.array(fields, dtype=np.float64).reshape(len(fields), len(names))
    # Rounded to the declared types, as a binary file has them.
    return np.column_stack([table[:, names.index(axis)].astype(types[axis]) for axis in "xyz"])


def _polygon(fields: list[list[float]], element: Element) -> list[float]:
    """Corners of a face: its list of this name, or its first, among other properties."""
    lists = [i for i, (_, _, is_list) in enumerate(element.properties) if is_list]
    named = [i for i in lists if element.properties[i][0].startswith("vertex_ind")]
    return fields[(named or lists)[0]] if lists else []


def read_obj(path: Path) -> MeshText:
    """Vertices and triangles of an OBJ file; all its objects and groups are one mesh.

    An incomplete line is refused, and a file with fewer vertices or faces than a comment states.
    """
    content = path.read_bytes().decode("latin-1").replace("\r\n", "\n").replace("\\\n", " ")
    vertices: list[list[float]] = []
    polygons: list[list[int]] = []
    stated = {"vertices": 0, "faces": 0}
    lines = content.split("\n")
    kinds: dict[str, list[str]] = {"v": [], "f": []}
    for number, line in enumerate(lines, 1):
        key, _, rest = line.strip().replace("\t", " ").partition(" ")
        if key not in kinds:
            if count := _STATED.match(line.strip()):
                what = (count["what"] or count["named"]).lower()
                stated[what] = max(stated[what], int(count["n"] or count["m"]))
            continue
        kinds[key].append(rest)
        try:
            if key == "v":
                x, y, z = rest.split()[:3]
                vertices.append([float(x), float(y), float(z)])
            else:
                corners = [int(corner.partition("/")[0]) for corner in rest.split()]
                _require_corners(corners)
                polygons.append([c - 1 if c > 0 else len(vertices) + c for c in corners])
        except ValueError:
            what = "vertex" if key == "v" else "face"
            raise InputError(
                f"{path}: line {number} holds {line.strip()[:60]!r}, not the numbers of one "
                f"{what}; the file is cut off or damaged, so export it again"
            ) from None
    triangles = _fan(polygons)
    for what, held in (("vertices", len(vertices)), ("faces", max(len(polygons), len(triangles)))):
        if held < stated[what]:
            raise InputError(
                f"{path}: a comment states {stated[what]} {what}, the file holds {held}; it is cut "
                "off, so export it again"
            )
    notes: tuple[str, ...] = ()
    if (ending := lines[-1].split()) and ending[0] in kinds:
        notes = notes_on_end(kinds[ending[0]], content, path)
    points = np.array(vertices, dtype=np.float64).reshape(-1, 3)
    return MeshText(*_used_alone(points, triangles), notes)


def _require_corners(corners: Sequence[int]) -> None:
    if len(corners) < 3 or 0 in corners or max(map(abs, corners)) > MAX_VERTICES:
        raise ValueError("a face has three corners or more, counted from 1")


def _used_alone(vertices: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Vertices that triangles use; all of a cloud without any, or of a damaged mesh."""
    if not len(triangles) or triangles.min() < 0 or triangles.max() >= len(vertices):
        return vertices, triangles
    used = np.zeros(len(vertices), dtype=bool)
    used[triangles] = True
    return vertices[used], (np.cumsum(used) - 1)[triangles]


def _fan(polygons: Sequence[Sequence[float]]) -> np.ndarray:
    """Triangles (m, 3) of polygons, all from the first corner of each; -1 for no number of one."""
    triangles = [
        (polygon[0], polygon[i], polygon[i + 1])
        for polygon in polygons
        for i in range(1, len(polygon) - 1)
    ]
    corners = np.array(triangles, dtype=np.float64).reshape(-1, 3)
    return np.where(abs(corners) < MAX_VERTICES, corners, -1).astype(np.int64)


def refuse_cut_stl(path: Path) -> None:
    """Refuse a text STL file that lacks the end of a solid or facet, or a vertex."""
    content = path.read_text(encoding="latin-1")
    counts = dict.fromkeys(("solid", "endsolid", "facet", "endfacet", "vertex"), 0)
    for word in _STL_LINE.findall(content):
        counts[word.lower()] += 1
    whole = len(_STL_VERTEX.findall(content))
    ends = counts["solid"] == counts["endsolid"] and counts["facet"] == counts["endfacet"]
    if not ends or not counts["vertex"] == whole == 3 * counts["facet"]:
        raise InputError(
            f"{path}: {counts['solid']} solids begin in it and {counts['endsolid']} end, "
            f"{counts['facet']} facets begin and {counts['endfacet']} end, with {whole} whole "
            "vertices; the file is cut off or damaged, so export it again"
        )


def binary_stream(stream: BinaryIO, header: PlyHeader) -> BinaryIO:
    """A binary PLY file with a header that trimesh understands."""
    return io.BytesIO(header.content + stream.read())
