# SPDX-License-Identifier: LGPL-2.1-or-later
"""ASTM E57 (ASTM E2807): the points and normals of all its scans, placed by their poses, in double precision.

Read here and not with FreeCAD's importer, which ignores the poses and rounds to single precision: several scans would
be put on top of each other. The file is text (XML) that points into binary sections; every page of the file ends with a
checksum that is not part of either.
"""
from __future__ import annotations

import struct
from dataclasses import dataclass
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError
from .. import xml_text

Array = NDArray[np.float64]

_HEADER = struct.Struct("<8s2I4Q")
_SECTION = struct.Struct("<B7x3Q")
_CHECKSUM = 4
_DATA_PACKET, _VECTOR_SECTION = 1, 1
_NAMESPACE = "{http://www.astm.org/COMMIT/E57/2010-e57-v1.0}"
_CARTESIAN = ("cartesianX", "cartesianY", "cartesianZ")
_SPHERICAL = ("sphericalRange", "sphericalAzimuth", "sphericalElevation")
_NORMALS = tuple(f"{{http://www.libe57.org/E57_NOR_surface_normals.txt}}normal{axis}" for axis in "XYZ")
_BITS_AT_ONCE = 1 << 25


@dataclass(frozen=True)
class _Field:
    """One column of a scan: how its numbers are stored.

    Attributes
    ----------
    name : "cartesianX", …
    bits : per number
    real : floating point, else an integer: value = (stored + minimum) · scale + offset
    """

    name: str
    bits: int
    real: bool
    minimum: int = 0
    scale: float = 1.0
    offset: float = 0.0

    def decode(self, data: bytes, count: int) -> Array:
        """The first ``count`` numbers of the column's byte stream."""
        if self.real:
            return np.frombuffer(data, f"<f{self.bits // 8}", count).astype(np.float64)
        if self.bits == 0:
            stored = np.zeros(count)
        elif self.bits in (8, 16, 32, 64):
            stored = np.frombuffer(data, f"<u{self.bits // 8}", count).astype(np.float64)
        else:
            stored = _unpack(np.frombuffer(data, np.uint8), self.bits, count)
        return (stored + self.minimum) * self.scale + self.offset


def _unpack(data: NDArray[np.uint8], bits: int, count: int) -> Array:
    """Unsigned integers of ``bits`` bits each, the lowest bit first."""
    power = 2.0 ** np.arange(bits)
    step = 8 * max(1, _BITS_AT_ONCE // (8 * bits))
    parts = []
    for first in range(0, count, step):
        number = min(step, count - first)
        start = first * bits // 8
        chunk = np.unpackbits(data[start : start + -(-number * bits // 8)], bitorder="little")
        parts.append(chunk[: number * bits].reshape(number, bits) @ power)
    return np.concatenate([np.empty(0), *parts])


def read(path: Path) -> Array:
    """The points of all scans in the file and their normals, (n, 6): invalid points are NaN, missing normals zero.

    Raises
    ------
    InputError : not an E57 file, or damaged
    """
    data = path.read_bytes()
    if data[:8] != b"ASTM-E57" or len(data) < _HEADER.size:
        raise InputError(f"The scan {path} is not an E57 file.")
    try:
        _, _, _, length, xml_offset, xml_length, page = _HEADER.unpack_from(data)
        if len(data) < length or page <= _CHECKSUM or length % page:
            raise ValueError("the file is cut off")
        content = _Content(data[:length], page)
        text = content.bytes(content.logical(xml_offset), xml_length)
        root = xml_text.parse(text)
        scans = [_scan(content, scan) for scan in root.iterfind(f"{_NAMESPACE}data3D/{_NAMESPACE}vectorChild")]
    except (ValueError, KeyError, TypeError, OverflowError, struct.error) as error:
        raise InputError(f"The scan {path} is damaged or cut off: its E57 sections cannot be read.") from error
    return np.concatenate([np.empty((0, 6)), *scans])


class _Content:
    """The file without its checksums."""

    def __init__(self, data: bytes, page: int) -> None:
        self._page = page
        self._data = np.frombuffer(data, np.uint8).reshape(-1, page)[:, :-_CHECKSUM].tobytes()

    def logical(self, physical: int) -> int:
        """Where a position in the file is once the checksums are taken out."""
        return physical - _CHECKSUM * (physical // self._page)

    def bytes(self, start: int, length: int) -> bytes:
        if start < 0 or length < 0 or start + length > len(self._data):
            raise ValueError("a section reaches beyond the file")
        return self._data[start : start + length]


def _scan(content: _Content, scan: Element) -> Array:
    """One scan's points and normals in the common frame of the file."""
    points = scan.find(f"{_NAMESPACE}points")
    prototype = None if points is None else points.find(f"{_NAMESPACE}prototype")
    if points is None or prototype is None:
        return np.empty((0, 6))
    fields = [_field(item) for item in prototype]
    count = int(points.get("recordCount", "0"))
    streams = _streams(content, int(points.get("fileOffset", "0")), fields, count)
    if not any(field.bits for field in fields if field.name in (*_CARTESIAN, *_SPHERICAL)):
        raise ValueError("no coordinate takes any room")  # and nothing bounds their number
    wanted = {*_CARTESIAN, *_SPHERICAL, *_NORMALS, "cartesianInvalidState", "sphericalInvalidState"}
    columns = {field.name: field.decode(stream, count) for field, stream in zip(fields, streams, strict=True)
               if field.name in wanted}
    if set(_CARTESIAN) <= set(columns):
        local, state = np.stack([columns[name] for name in _CARTESIAN], axis=1), "cartesianInvalidState"
    else:
        local, state = _from_spherical(*(columns[name] for name in _SPHERICAL)), "sphericalInvalidState"
    if state in columns:
        local[columns[state] != 0] = np.nan
    normals = (np.stack([columns[name] for name in _NORMALS], axis=1) if set(_NORMALS) <= set(columns)
               else np.zeros((count, 3)))
    rotation, translation = _motion(scan.find(f"{_NAMESPACE}pose"))
    return np.hstack([local @ rotation.T + translation, normals @ rotation.T])


def _field(item: Element) -> _Field:
    name = item.tag.removeprefix(_NAMESPACE)
    if item.get("type") == "Float":
        return _Field(name, 32 if item.get("precision") == "single" else 64, True)
    low, high = int(item.get("minimum", -(2**63))), int(item.get("maximum", 2**63 - 1))
    if not -(2**63) <= low <= high < 2**63:
        raise ValueError("no range of integers")
    scaled = item.get("type") == "ScaledInteger"
    return _Field(name, (high - low).bit_length(), False, low, float(item.get("scale", 1)) if scaled else 1.0,
                  float(item.get("offset", 0)) if scaled else 0.0)


def _streams(content: _Content, physical: int, fields: list[_Field], count: int) -> list[bytes]:
    """The byte stream of each column, put together from the packets of the section at ``physical``."""
    start = content.logical(physical)
    kind, length, first, _ = _SECTION.unpack(content.bytes(start, _SECTION.size))
    if kind != _VECTOR_SECTION or count < 0:
        raise ValueError("not a section of points")
    end, position = start + length, content.logical(first)
    parts: list[list[bytes]] = [[] for _ in fields]
    missing = [-(-count * field.bits // 8) for field in fields]
    while position < end and any(size > 0 for size in missing):
        kind, _, length = struct.unpack("<BBH", content.bytes(position, 4))
        if length % 4 != 3:
            raise ValueError("packets are made of four bytes each")
        packet = content.bytes(position, length + 1)
        if kind == _DATA_PACKET:
            number = struct.unpack_from("<H", packet, 4)[0]
            lengths = struct.unpack_from(f"<{number}H", packet, 6)
            place = 6 + 2 * number
            for column, (part, size) in enumerate(zip(parts, lengths, strict=True)):
                part.append(packet[place : place + size])
                missing[column] -= len(part[-1])
                place += size
        position += length + 1
    if any(size > 0 for size in missing):
        raise ValueError("a column is cut off")
    return [b"".join(part) for part in parts]


def _from_spherical(distance: Array, azimuth: Array, elevation: Array) -> Array:
    flat = distance * np.cos(elevation)
    return np.stack([flat * np.cos(azimuth), flat * np.sin(azimuth), distance * np.sin(elevation)], axis=1)


def _motion(pose: Element | None) -> tuple[Array, Array]:
    """Rotation (3, 3) by the pose's unit quaternion, and its translation (3,)."""
    if pose is None:
        return np.eye(3), np.zeros(3)
    w, x, y, z = (_number(pose, "rotation", axis, 1.0 if axis == "w" else 0.0) for axis in "wxyz")
    rotation = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                         [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                         [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])
    return rotation, np.array([_number(pose, "translation", axis, 0.0) for axis in "xyz"])


def _number(pose: Element, part: str, axis: str, default: float) -> float:
    group = pose.find(f"{_NAMESPACE}{part}")
    item = None if group is None else group.find(f"{_NAMESPACE}{axis}")
    if group is None:
        return default
    return float(item.text) if item is not None and item.text and item.text.strip() else 0.0
