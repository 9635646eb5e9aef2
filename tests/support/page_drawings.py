"""Words of the drawings of a page: whether they can be read."""

#: Pairs of words of a drawing that lie over each other, and words that leave it.
_UNREADABLE = """drawing => {
  const texts = [...drawing.querySelectorAll("text")];
  const words = texts.map((one) => [one.textContent, one.getBoundingClientRect()]);
  const all = drawing.getBoundingClientRect(), found = [];
  words.forEach(([text, a], i) => {
    if (a.left < all.left - 1 || a.right > all.right + 1) found.push(`${text} is cut off`);
    for (const [other, b] of words.slice(i + 1)) {
      const across = Math.min(a.right, b.right) - Math.max(a.left, b.left);
      const up = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
      if (across > 0 && up > 0) found.push(`${text} over ${other}`);
    }
  });
  return [words.length, found];
}"""


def assert_readable(drawing):
    """All words of a drawing, a locator of one SVG, stand inside it and apart from each other."""
    words, found = drawing.evaluate(_UNREADABLE)
    assert words > 4
    assert found == []
