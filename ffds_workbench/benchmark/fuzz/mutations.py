# SPDX-License-Identifier: LGPL-2.1-or-later
"""Typical damage of files: flipped bits, parts lost, doubled or swapped, numbers that make no sense."""
from __future__ import annotations

import re
import struct
from collections.abc import Callable, Sequence

import numpy as np

_NUMBER = re.compile(rb"[-+]?\d+(\.\d*)?([eE][-+]?\d+)?")
_NUMBERS = (b"0", b"-1", b"1", b"nan", b"inf", b"-inf", b"1e308", b"1e-320", b"1e999", b"2147483648", b"4294967295",
            b"9223372036854775807", b"18446744073709551616", b"9" * 400, b"0x10", b"1,5", b"1_0", b"", b"\xc2\xb2")
_BINARY = (b"\0" * 4, b"\xff" * 4, b"\xff\xff\xff\x7f", b"\0\0\0\x80", struct.pack("<f", np.inf),
           struct.pack("<f", np.nan), struct.pack("<d", 1e300), b"\0" * 64, b"\xff" * 64)
_PIECE = 64
"""Longest piece in bytes that is lost, doubled or moved at a time; every fourth is ten times as long."""


def mutated(seed: bytes, others: Sequence[bytes], random: np.random.Generator) -> bytes:
    """A file's content with one to four kinds of damage; ``others`` are files that pieces may come from."""
    data = seed
    for _ in range(int(random.integers(1, 5))):
        data = _DAMAGE[random.integers(len(_DAMAGE))](data, others, random)
    return data


def _place(data: bytes, random: np.random.Generator) -> int:
    """Anywhere, every second time near the beginning, where headers are."""
    reach = len(data) if random.random() < 0.5 else min(len(data), 512)
    return int(random.integers(reach + 1))


def _length(random: np.random.Generator) -> int:
    return int(random.integers(1, _PIECE + 1)) * (10 if random.random() < 0.25 else 1)


def _bits(data: bytes, others: Sequence[bytes], random: np.random.Generator) -> bytes:
    changed = bytearray(data)
    for _ in range(int(random.integers(1, 9))):
        if changed:
            changed[min(_place(data, random), len(changed) - 1)] ^= 1 << int(random.integers(8))
    return bytes(changed)


def _overwrite(data: bytes, others: Sequence[bytes], random: np.random.Generator) -> bytes:
    piece = _BINARY[random.integers(len(_BINARY))] if random.random() < 0.5 else random.bytes(_length(random))
    at = _place(data, random)
    return data[:at] + piece + data[at + len(piece) :]


def _cut_off(data: bytes, others: Sequence[bytes], random: np.random.Generator) -> bytes:
    return data[: _place(data, random)]


def _lose(data: bytes, others: Sequence[bytes], random: np.random.Generator) -> bytes:
    at = _place(data, random)
    return data[:at] + data[at + _length(random) :]


def _double(data: bytes, others: Sequence[bytes], random: np.random.Generator) -> bytes:
    at = _place(data, random)
    return data[:at] + data[at : at + _length(random)] * int(random.integers(2, 9)) + data[at:]


def _mix(data: bytes, others: Sequence[bytes], random: np.random.Generator) -> bytes:
    other = others[random.integers(len(others))]
    at, there = _place(data, random), _place(other, random)
    return data[:at] + other[there : there + _length(random)] + data[at + int(random.integers(2)) * _length(random) :]


def _number(data: bytes, others: Sequence[bytes], random: np.random.Generator) -> bytes:
    found = [match.span() for match in _NUMBER.finditer(data[:2000] if random.random() < 0.5 else data)]
    if not found:
        return data
    start, end = found[random.integers(len(found))]
    return data[:start] + _NUMBERS[random.integers(len(_NUMBERS))] + data[end:]


def _lines(data: bytes, others: Sequence[bytes], random: np.random.Generator) -> bytes:
    lines = data.split(b"\n")
    first, second = random.integers(len(lines), size=2)
    lines[first], lines[second] = lines[second], lines[first]
    return b"\n".join(lines)


_DAMAGE: tuple[Callable[[bytes, Sequence[bytes], np.random.Generator], bytes], ...] = (
    _bits, _overwrite, _cut_off, _lose, _double, _mix, _number, _lines)
