# SPDX-License-Identifier: LGPL-2.1-or-later
"""E57 files, written here byte by byte after ASTM E2807 (no library at hand writes them)."""
from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest

from ffds_workbench.errors import InputError
from ffds_workbench.scan import files

PAGE, PAYLOAD, HEADER = 1024, 1020, 48


def _crc32c(data: bytes) -> int:
    crc = 0xFFFFFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = (crc >> 1) ^ (0x82F63B78 if crc & 1 else 0)
    return crc ^ 0xFFFFFFFF


def _physical(logical: int) -> int:
    return logical + 4 * (logical // PAYLOAD)


def write_e57(path: Path, points: np.ndarray, translation=(0.0, 0.0, 0.0)) -> None:
    """Doubles, one packet, a pose that only moves."""
    streams = [points[:, axis].astype("<f8").tobytes() for axis in range(3)]
    body = struct.pack("<3H", *map(len, streams)) + b"".join(streams)
    length = 6 + len(body)
    padding = -length % 4
    packet = struct.pack("<BBHH", 1, 0, length + padding - 1, 3) + body + b"\0" * padding
    section = struct.pack("<B7xQQQ", 1, 32 + len(packet), _physical(HEADER + 32), 0) + packet
    x, y, z = translation
    xml = f"""<?xml version="1.0" encoding="UTF-8"?>
<e57Root type="Structure" xmlns="http://www.astm.org/COMMIT/E57/2010-e57-v1.0">
<formatName type="String">ASTM E57 3D Imaging Data File</formatName><guid type="String">{{a}}</guid>
<versionMajor type="Integer">1</versionMajor><versionMinor type="Integer">0</versionMinor>
<data3D type="Vector" allowHeterogeneousChildren="1"><vectorChild type="Structure"><guid type="String">{{b}}</guid>
<pose type="Structure"><translation type="Structure"><x type="Float">{x}</x><y type="Float">{y}</y>
<z type="Float">{z}</z></translation></pose>
<points type="CompressedVector" fileOffset="{HEADER}" recordCount="{len(points)}">
<prototype type="Structure"><cartesianX type="Float"/><cartesianY type="Float"/><cartesianZ type="Float"/></prototype>
<codecs type="Vector" allowHeterogeneousChildren="1"></codecs></points></vectorChild></data3D></e57Root>""".encode()
    logical = HEADER + len(section)
    pages = -(-(logical + len(xml)) // PAYLOAD)
    header = struct.pack("<8s2I4Q", b"ASTM-E57", 1, 0, pages * PAGE, _physical(logical), len(xml), PAGE)
    content = (header + section + xml).ljust(pages * PAYLOAD, b"\0")
    chunks = [content[start : start + PAYLOAD] for start in range(0, len(content), PAYLOAD)]
    path.write_bytes(b"".join(chunk + struct.pack(">I", _crc32c(chunk)) for chunk in chunks))


def test_points_and_pose_are_read(tmp_path):
    points = np.random.default_rng(5).uniform(-0.1, 0.1, (300, 3))
    write_e57(tmp_path / "scan.e57", points, (1.0, 2.0, -3.0))
    cloud = files.read(tmp_path / "scan.e57", "m")
    # FreeCAD stores single precision: half a step at 3 m is 0.12 µm.
    np.testing.assert_allclose(cloud.points, (points + (1, 2, -3)) * 1000, atol=2e-4)


def test_coordinates_too_large_for_single_precision_are_refused(tmp_path):
    points = np.random.default_rng(5).uniform(0, 0.1, (300, 3)) + (4.5e5, 5.4e6, 0)
    write_e57(tmp_path / "scan.e57", points)
    with pytest.raises(InputError, match="too far from its origin"):
        files.read(tmp_path / "scan.e57", "m")


@pytest.mark.parametrize("damage", [lambda data: data[: len(data) // 2], lambda data: data[:100],
                                    lambda data: data[:200] + b"XXXX" + data[204:], lambda data: b"nothing of the sort"])
def test_damaged_files_are_refused(tmp_path, damage):
    path = tmp_path / "scan.e57"
    write_e57(path, np.random.default_rng(5).uniform(0, 1, (300, 3)))
    path.write_bytes(damage(path.read_bytes()))
    with pytest.raises(InputError, match="E57"):
        files.read(path)
