# SPDX-License-Identifier: LGPL-2.1-or-later
"""E57 files, written here byte by byte after ASTM E2807; FreeCAD's own importer is the second reader."""
from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest

from ffds_workbench.errors import InputError
from ffds_workbench.scan import files

PAGE, PAYLOAD, HEADER = 1024, 1020, 48
POINTS = np.random.default_rng(5).uniform(-0.1, 0.1, (3000, 3))
BITS, SCALE = 21, 1e-7
NO_POSE = ""
POSE = ('<pose type="Structure"><rotation type="Structure"><w type="Float">0.6</w><x type="Float"/><y type="Float"/>'
        '<z type="Float">0.8</z></rotation><translation type="Structure"><x type="Float">1e3</x>'
        '<y type="Float">2e3</y><z type="Float">-3</z></translation></pose>')


def _crc32c(data: bytes) -> int:
    crc = 0xFFFFFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = (crc >> 1) ^ (0x82F63B78 if crc & 1 else 0)
    return crc ^ 0xFFFFFFFF


def _physical(logical: int) -> int:
    return logical + 4 * (logical // PAYLOAD)


def _packets(streams: list[bytes], size: int) -> bytes:
    """Data packets that take ``size`` bytes of each stream at a time."""
    result = b""
    for start in range(0, max(map(len, streams)), size):
        parts = [stream[start : start + size] for stream in streams]
        body = struct.pack(f"<{len(parts)}H", *map(len, parts)) + b"".join(parts)
        padding = -(6 + len(body)) % 4
        result += struct.pack("<BBHH", 1, 0, 5 + len(body) + padding, len(parts)) + body + b"\0" * padding
    return result


def write_e57(path: Path, scans: list[tuple[list[bytes], int, str, str]]) -> None:
    """Scans of (byte streams, number of points, fields as XML, pose as XML)."""
    content, xml = b"\0" * HEADER, ""
    for streams, count, fields, pose in scans:
        packets = _packets(streams, 1600)
        xml += (f'<vectorChild type="Structure"><guid type="String">b</guid>{pose}<points type="CompressedVector" '
                f'fileOffset="{_physical(len(content))}" recordCount="{count}"><prototype type="Structure">{fields}'
                '</prototype><codecs type="Vector" allowHeterogeneousChildren="1"/></points></vectorChild>')
        content += struct.pack("<B7xQQQ", 1, 32 + len(packets), _physical(len(content) + 32), 0) + packets
    text = ('<?xml version="1.0" encoding="UTF-8"?><e57Root type="Structure" '
            'xmlns="http://www.astm.org/COMMIT/E57/2010-e57-v1.0" '
            'xmlns:nor="http://www.libe57.org/E57_NOR_surface_normals.txt"><formatName type="String">ASTM E57 '
            '3D Imaging Data File</formatName><guid type="String">a</guid>'
            '<versionMajor type="Integer">1</versionMajor><versionMinor type="Integer">0</versionMinor>'
            '<data3D type="Vector" allowHeterogeneousChildren="1">'
            f'{xml}</data3D></e57Root>').encode()
    pages = -(-(len(content) + len(text)) // PAYLOAD)
    header = struct.pack("<8s2I4Q", b"ASTM-E57", 1, 0, pages * PAGE, _physical(len(content)), len(text), PAGE)
    whole = (header + content[HEADER:] + text).ljust(pages * PAYLOAD, b"\0")
    chunks = [whole[start : start + PAYLOAD] for start in range(0, len(whole), PAYLOAD)]
    path.write_bytes(b"".join(chunk + struct.pack(">I", _crc32c(chunk)) for chunk in chunks))


def doubles(points: np.ndarray = POINTS, pose: str = NO_POSE) -> tuple[list[bytes], int, str, str]:
    fields = "".join(f'<cartesian{axis} type="Float"/>' for axis in "XYZ")
    return [points[:, axis].astype("<f8").tobytes() for axis in range(3)], len(points), fields, pose


def with_normals(points: np.ndarray, normals: np.ndarray, pose: str) -> tuple[list[bytes], int, str, str]:
    streams, count, fields, _ = doubles(points)
    fields += "".join(f'<nor:normal{axis} type="Float" precision="single"/>' for axis in "XYZ")
    return streams + [normals[:, axis].astype("<f4").tobytes() for axis in range(3)], count, fields, pose


def scaled_integers() -> tuple[list[bytes], int, str, str]:
    """21 bits a number, so that numbers straddle bytes and packets; a state of one bit that marks every tenth."""
    half = 1 << (BITS - 1)
    stored = np.rint(POINTS / SCALE).astype(np.int64) + half
    streams = [np.packbits((column[:, None] >> np.arange(BITS)) & 1, bitorder="little").tobytes()
               for column in stored.T]
    fields = "".join(f'<cartesian{axis} type="ScaledInteger" minimum="{-half}" maximum="{half - 1}" scale="{SCALE}"/>'
                     for axis in "XYZ")
    state = np.arange(len(POINTS)) % 10 == 0
    streams.append(np.packbits(state, bitorder="little").tobytes())
    return streams, len(POINTS), fields + '<cartesianInvalidState type="Integer" minimum="0" maximum="1"/>', NO_POSE


def spherical() -> tuple[list[bytes], int, str, str]:
    x, y, z = POINTS.T
    columns = np.sqrt(x**2 + y**2 + z**2), np.arctan2(y, x), np.arctan2(z, np.hypot(x, y))
    fields = "".join(f'<spherical{name} type="Float"/>' for name in ("Range", "Azimuth", "Elevation"))
    return [column.astype("<f8").tobytes() for column in columns], len(POINTS), fields, NO_POSE


def test_doubles_are_read_to_the_last_bit(tmp_path):
    write_e57(tmp_path / "scan.e57", [doubles()])
    np.testing.assert_array_equal(files.read(tmp_path / "scan.e57").points, POINTS)


def test_packed_integers_and_invalid_points(tmp_path):
    write_e57(tmp_path / "scan.e57", [scaled_integers()])
    cloud = files.read(tmp_path / "scan.e57")
    valid = np.arange(len(POINTS)) % 10 != 0
    np.testing.assert_allclose(cloud.points, POINTS[valid], atol=0.51 * SCALE)
    assert cloud.dropped == (~valid).sum()


def test_spherical_coordinates(tmp_path):
    write_e57(tmp_path / "scan.e57", [spherical()])
    np.testing.assert_allclose(files.read(tmp_path / "scan.e57").points, POINTS, atol=1e-15)


def test_every_scan_is_placed_by_its_pose(tmp_path):
    write_e57(tmp_path / "scan.e57", [doubles(), doubles(POINTS[:7], POSE)])
    cloud = files.read(tmp_path / "scan.e57", "m")
    x, y, z = POINTS[:7].T
    placed = np.stack([-0.28 * x - 0.96 * y + 1e3, 0.96 * x - 0.28 * y + 2e3, z - 3], axis=1)
    np.testing.assert_allclose(cloud.points[len(POINTS) :], placed * 1000, atol=1e-9 * 1e6)


def test_normals_are_turned_by_the_pose(tmp_path):
    normals = POINTS[:9] / np.linalg.norm(POINTS[:9], axis=1, keepdims=True)
    write_e57(tmp_path / "scan.e57", [doubles(POINTS[9:12]), with_normals(POINTS[:9], normals, POSE)])
    cloud = files.read(tmp_path / "scan.e57", "m")
    x, y, z = normals.T
    # Single precision, half a step at 1 is 6e-8.
    np.testing.assert_allclose(cloud.normals[3:], np.stack([-0.28 * x - 0.96 * y, 0.96 * x - 0.28 * y, z], axis=1),
                               atol=2e-7)
    assert not cloud.normals[:3].any()


@pytest.mark.parametrize("scan", [doubles(), scaled_integers()], ids=["doubles", "scaled integers"])
def test_freecad_reads_the_same_points(tmp_path, scan):
    import FreeCAD
    import Points

    path = tmp_path / "scan.e57"
    write_e57(path, [scan])
    document = FreeCAD.newDocument("E57", hidden=True, temp=True)
    Points.insert(str(path), document.Name)
    theirs = np.array([tuple(point) for point in document.Objects[0].Points.Points])
    FreeCAD.closeDocument(document.Name)
    # FreeCAD stores single precision: half a step at 0.1 is 4e-9.
    np.testing.assert_allclose(files.read(path).points, theirs, atol=1e-8)


@pytest.mark.parametrize("damage", [lambda data: data[: len(data) // 2], lambda data: data[:100],
                                    lambda data: data[:48] + b"\7" + data[49:],
                                    lambda data: data.replace(b"recordCount=\"3", b"recordCount=\"9"),
                                    lambda data: data.replace(b"<data3D", b"<data3E"),
                                    lambda data: b"nothing of the sort"])
def test_damaged_files_are_refused(tmp_path, damage):
    path = tmp_path / "scan.e57"
    write_e57(path, [doubles()])
    path.write_bytes(damage(path.read_bytes()))
    with pytest.raises(InputError, match="E57"):
        files.read(path)
