"""Ways to spoil a file. Each takes its bytes and a random generator and gives other bytes."""

import io
import re
import struct
import zipfile

HEAD = 2048  # bytes that hold the header of most formats
_TEXT_PROBES = (
    b"1e999", b"-1e999", b"nan", b"inf", b"1e-320", b"9" * 400, b"0", b"-1", b"1,5", b"1.2.3",
    b"--", b"\x00", b"\xff\xfe", "Öµ½".encode(), "µ".encode("latin-1"), b"\r", b"\x1a", b"\x1b[2J",
    b"x" * 20_000, b"," * 5_000, b"# ", b'"', b"'", b"\n\n\n", b"0x10", b"1e5 mm", b"%s", b"{0}",
    b"<!DOCTYPE a [<!ENTITY b 'c'>]>", b"&b;", b"</", b"\t",
)  # fmt: skip
_ASCII_NUMBERS = (
    b"0", b"-1", b"1", b"65536", b"2147483647", b"4294967295", b"-2147483648",
    b"18446744073709551615", b"999999999999", b"1e9", b"1e308", b"nan", b"",
)  # fmt: skip
_BINARY_NUMBERS = (0, 1, -1, 0x7F, 0x7FFF, 0xFFFF, 0x10000, 0x7FFFFFFF, 0x80000000, 10**6, 10**9)


def cut(content, rng):
    """A copy that broke off."""
    return content[: rng.integers(len(content) + 1)]


def flip_bits(content, rng):
    changed = bytearray(content)
    for place in rng.integers(len(changed), size=_few(rng)):
        changed[place] ^= 1 << rng.integers(8)
    return bytes(changed)


def scramble_bytes(content, rng):
    """Other bytes in the header, where they say most."""
    changed = bytearray(content)
    for place in rng.integers(min(HEAD, len(changed)), size=_few(rng)):
        changed[place] = rng.integers(256)
    return bytes(changed)


def blow_up_a_binary_number(content, rng):
    """A size, count or offset in the header that is far too large, zero or below."""
    form, bits = (("H", 16), ("I", 32), ("Q", 64))[rng.integers(3)]
    size = bits // 8
    place = int(rng.integers(max(1, min(HEAD, len(content)) - size)))
    if rng.random() < 0.7:  # most formats align their numbers
        place -= place % min(size, 4)
    value = _BINARY_NUMBERS[rng.integers(len(_BINARY_NUMBERS))] % 2**bits
    number = struct.pack("<>"[rng.integers(2)] + form, value)
    return content[:place] + number + content[place + size :]


def blow_up_a_binary_float(content, rng):
    """A scale or an offset that is no number, none or enormous."""
    form = "fd"[rng.integers(2)]
    size = struct.calcsize(form)
    place = int(rng.integers(max(1, len(content) - size)))
    value = (float("nan"), float("inf"), 0.0, -1.0, 1e30, 1e-38)[rng.integers(6)]
    return content[:place] + struct.pack(f"<{form}", value) + content[place + size :]


def blow_up_a_written_number(content, rng):
    """The same where the header is text."""
    numbers = list(re.finditer(rb"[-+]?\d+(\.\d+)?", content[:HEAD]))
    if not numbers:
        return flip_bits(content, rng)
    match = numbers[rng.integers(len(numbers))]
    return content[: match.start()] + _pick(_ASCII_NUMBERS, rng) + content[match.end() :]


def swap_chunks(content, rng):
    a, b, c, d = sorted(int(n) for n in rng.integers(len(content) + 1, size=4))
    return content[:a] + content[c:d] + content[b:c] + content[a:b] + content[d:]


def insert_noise(content, rng):
    place = rng.integers(len(content) + 1)
    return content[:place] + rng.bytes(int(2 ** rng.integers(12))) + content[place:]


def insert_text(content, rng):
    """What people and programs put into text where nobody expects it."""
    place = rng.integers(min(HEAD, len(content)) if rng.random() < 0.5 else len(content) + 1)
    return content[:place] + _pick(_TEXT_PROBES, rng) + content[place:]


def replace_a_word(content, rng):
    words = list(re.finditer(rb"[^\s,;<>]+", content[: 4 * HEAD]))
    if not words:
        return insert_text(content, rng)
    match = words[rng.integers(len(words))]
    return content[: match.start()] + _pick(_TEXT_PROBES, rng) + content[match.end() :]


def repeat_block(content, rng):
    start, end = sorted(int(n) for n in rng.integers(len(content) + 1, size=2))
    return content[:end] + content[start:end][:65_536] * int(_few(rng)) + content[end:]


def drop_block(content, rng):
    start, end = sorted(int(n) for n in rng.integers(len(content) + 1, size=2))
    return content[:start] + content[end:]


def join_lines(content, rng):
    """All on one line, or other ends of lines."""
    end = (b"", b" ", b"\r", b"\r\n\r\n", b"\x00\n")[rng.integers(5)]
    return content.replace(b"\n", end)


def change_the_encoding(content, rng):
    encoding = ("utf-16", "utf-16-be", "utf-32", "cp037")[rng.integers(4)]
    return content.decode("latin-1").encode(encoding, errors="replace")


ANY = (
    cut, flip_bits, scramble_bytes, blow_up_a_binary_number, blow_up_a_binary_float,
    blow_up_a_written_number, swap_chunks, insert_noise, insert_text, replace_a_word,
    repeat_block, drop_block,
)  # fmt: skip
TEXT_ONLY = (join_lines, change_the_encoding, insert_text, replace_a_word)


def spoil(content: bytes, rng) -> bytes:
    """One mutation, at times two or three; archives are often opened and packed again."""
    for _ in range((1, 1, 1, 2, 3)[rng.integers(5)]):
        if not content:
            break
        if content.startswith(b"PK") and rng.random() < 0.6:
            content = _spoil_archive(content, rng)
        elif b"\x00" not in content and rng.random() < 0.3:
            content = _pick(TEXT_ONLY, rng)(content, rng)
        else:
            content = _pick(ANY, rng)(content, rng)
    return content


def _spoil_archive(content, rng):
    """Spoil a member, its name or its place, so that the archive itself is sound."""
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            members = [(member.filename, archive.read(member)) for member in archive.infolist()]
    except Exception:  # an archive that is spoilt already
        members = []
    if not members:
        return flip_bits(content, rng)
    chosen = rng.integers(len(members))
    name, data = members[chosen]
    match rng.integers(6):
        case 0:
            members.append((name, data))
        case 1:
            members[chosen] = (
                f"{('../', '/', 'C:/', 'a/', chr(0x202E))[rng.integers(5)]}{name}",
                data,
            )
        case 2:
            del members[chosen]
        case _:
            members[chosen] = (name, _pick(ANY, rng)(data, rng) if data else b"\x00")
    packed = io.BytesIO()
    method = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2)[rng.integers(3)]
    with zipfile.ZipFile(packed, "w", method) as archive:
        for name, data in members:
            archive.writestr(name, data)
    return packed.getvalue()


def _few(rng):
    return int(2 ** rng.integers(5))


def _pick(choices, rng):
    return choices[rng.integers(len(choices))]
