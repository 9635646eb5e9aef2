"""What pages and cards say, for `same.py`: visible text, and data by name."""

import base64
import json
import re
import zlib
from html.parser import HTMLParser

import numpy as np

#: Words that differ between two runs of equal numbers, and what stands for them.
MAY_DIFFER = (
    # The time at which a page was made.
    (re.compile(r"\d{4}-\d\d-\d\d \d\d:\d\d UTC"), "DATE"),
    # What the jobs took.
    (re.compile(r"[\d hmins]+ of work in \d+ jobs"), " TIME of work"),
    # Libraries that were installed, and the release of this package.
    (re.compile(r"Computed with fractalcontact[^;]*?\d(?=\.(\s|$))"), "Computed with VERSIONS"),
)
#: Attributes of HTML that a reader sees or hears.
SHOWN_ATTRIBUTES = ("alt", "aria-label", "title", "placeholder")
#: Elements that do not end a line of text.
INLINE = {"a", "b", "code", "em", "i", "small", "span", "strong", "sub", "sup"}


class _Page(HTMLParser):
    def __init__(self):
        super().__init__()
        self.parts, self.data = [], {}
        self.skipped, self.block = None, None

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        if tag in ("script", "style"):
            is_data = attrs.get("type") == "application/json"
            self.skipped = tag
            self.block = attrs.get("id", "data") if is_data else None
        else:
            self.parts.append("" if tag in INLINE else "\n")
        self.parts += [f"[{attrs[name]}]" for name in SHOWN_ATTRIBUTES if attrs.get(name)]

    def handle_endtag(self, tag):
        if tag == self.skipped:
            self.skipped = self.block = None
        self.parts.append("" if tag in INLINE else "\n")

    def handle_data(self, data):
        if self.block is not None:
            self.data[self.block] = self.data.get(self.block, "") + data
        elif self.skipped is None:
            self.parts.append(data)


def page_contents(html):
    """Visible text of a page, a block a line, and its data by the name of the element.

    Packed numbers of the explorer are unpacked to arrays.
    """
    page = _Page()
    page.feed(html)
    page.close()
    text = without_what_may_differ("".join(page.parts))
    lines = (" ".join(line.split()) for line in text.split("\n"))
    data = {name: unpacked(json.loads(block)) for name, block in page.data.items()}
    return "\n".join(line for line in lines if line), data


def without_what_may_differ(text):
    """A text without times and versions."""
    for pattern, word in MAY_DIFFER:
        text = pattern.sub(word, text)
    return text


def unpacked(data):
    """Data of the explorer with an array in place of each part of the packed numbers."""
    if not isinstance(data, dict) or not {"arrays", "numbers"} <= set(data):
        return data
    packed = np.frombuffer(zlib.decompress(base64.b64decode(data["numbers"])), np.uint8)
    numbers = np.ascontiguousarray(packed.reshape(8, -1).T).view("<f8").ravel()
    arrays = {}
    for key, about in data["arrays"].items():
        size = int(np.prod(about["shape"], dtype=int))
        values = numbers[about["start"] : about["start"] + size].reshape(about["shape"])
        arrays[key] = {**about, "values": values}
        del arrays[key]["start"]
    rest = {key: value for key, value in data.items() if key not in ("arrays", "numbers")}
    return {**rest, "arrays": arrays}


def leaves(data):
    """Values of nested data by their paths, `a/b`; a list of records gives a list for each key."""
    if isinstance(data, dict):
        found = {}
        for key, value in data.items():
            for path, leaf in leaves(value).items():
                found[f"{key}/{path}" if path else str(key)] = leaf
        return found or {"": {}}
    if isinstance(data, list) and data and all(isinstance(row, dict) for row in data):
        rows = [leaves(row) for row in data]
        paths = dict.fromkeys(path for row in rows for path in row)
        return {path: [row.get(path) for row in rows] for path in paths}
    return {"": data}
