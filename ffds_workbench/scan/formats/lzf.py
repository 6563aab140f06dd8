# SPDX-License-Identifier: LGPL-2.1-or-later
"""Decompression of LZF (Marc Lehmann's liblzf), which compressed PCD files use.

Own code because open3d's ends the whole process where a file is damaged. One step per token, not per byte.
"""
from __future__ import annotations

LARGEST_GAIN = 88
"""Theory: three bytes, the longest reference, stand for at most 264."""


def decompress(data: bytes, size: int) -> bytes:
    """Decompress ``data`` to ``size`` bytes.

    A byte below 32 goes before one more literal bytes than it says. Any other begins a reference to what is there
    already: its three high bits, and the next byte where they are all set, are the length less two, its five low bits
    and the byte after that how far back it starts, less one. A reference may overlap what it makes.

    Raises
    ------
    ValueError : the data do not make ``size`` bytes
    """
    result = bytearray()
    position, end = 0, len(data)
    try:
        while position < end and len(result) <= size:
            control = data[position]
            position += 1
            if control < 32:
                result += data[position : position + control + 1]
                position += control + 1
                continue
            length = 2 + (control >> 5)
            if length == 9:
                length += data[position]
                position += 1
            start = len(result) - ((control & 31) << 8) - data[position] - 1
            position += 1
            if start < 0:
                raise ValueError("a reference reaches before the beginning")
            piece = result[start : start + length]
            result += piece if len(piece) == length else (piece * (length // len(piece) + 1))[:length]
    except IndexError as error:
        raise ValueError("the last reference is cut off") from error
    if len(result) != size or position != end:
        raise ValueError("the length is another one")
    return bytes(result)
