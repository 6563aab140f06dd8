# SPDX-License-Identifier: LGPL-2.1-or-later
"""Normals in scan files of every format that holds them, and columns that look like normals but are none."""
from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest

from ffds_workbench.scan import files
from ffds_workbench.scan.sensor.files import write_ply

_RANDOM = np.random.default_rng(2)
POINTS = _RANDOM.uniform(-50, 50, (60, 3))
NORMALS = _RANDOM.normal(size=(60, 3))
NORMALS /= np.linalg.norm(NORMALS, axis=1, keepdims=True)
ROWS = np.hstack([POINTS, NORMALS])
TEXT = "".join(" ".join(map(repr, row)) + "\n" for row in ROWS.tolist())
# Normals are made unit vectors again on reading, which rounds.
ROUNDED = 1e-15


def read(folder: Path, name: str, content: bytes | str):
    (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    return files.read(folder / name)


def ply(encoding: str) -> bytes:
    """Colours between the coordinates and the normals, which are in single precision."""
    header = "".join(f"property double {axis}\n" for axis in "xyz") + "property uchar red\n"
    header += "".join(f"property float n{axis}\n" for axis in "xyz")
    data = f"ply\nformat {encoding} 1.0\nelement vertex {len(ROWS)}\n{header}end_header\n".encode()
    for row in ROWS.tolist():
        data += (f"{row[0]!r} {row[1]!r} {row[2]!r} 9 {row[3]:.9g} {row[4]:.9g} {row[5]:.9g}\n".encode()
                 if encoding == "ascii" else struct.pack("<3dB3f", *row[:3], 9, *row[3:]))
    return data


def pcd(encoding: str) -> bytes:
    data = (f"VERSION 0.7\nFIELDS x y z normal_x normal_y normal_z curvature\nSIZE 8 8 8 4 4 4 4\nTYPE F F F F F F F\n"
            f"COUNT 1 1 1 1 1 1 1\nWIDTH {len(ROWS)}\nHEIGHT 1\nPOINTS {len(ROWS)}\nDATA {encoding}\n").encode()
    for row in ROWS.tolist():
        data += (" ".join(map(repr, row)) + " 0.1\n").encode() if encoding == "ascii" else struct.pack(
            "<3d4f", *row, 0.1)
    return data


@pytest.mark.parametrize("content", [ply("ascii"), ply("binary_little_endian"), pcd("ascii"), pcd("binary")],
                         ids=["ply ascii", "ply binary", "pcd ascii", "pcd binary"])
def test_named_normals(tmp_path, content):
    cloud = read(tmp_path, "s.ply" if content.startswith(b"ply") else "s.pcd", content)
    np.testing.assert_array_equal(cloud.points, POINTS)
    # Single precision, half a step at 1 is 6e-8.
    np.testing.assert_allclose(cloud.normals, NORMALS, atol=2e-7)


def test_compressed_pcd(tmp_path):
    open3d = pytest.importorskip("open3d")
    cloud = open3d.t.geometry.PointCloud(open3d.core.Tensor(POINTS))
    cloud.point["normals"] = open3d.core.Tensor(NORMALS)
    open3d.t.io.write_point_cloud(str(tmp_path / "s.pcd"), cloud, compressed=True)
    np.testing.assert_allclose(files.read(tmp_path / "s.pcd").normals, NORMALS, atol=ROUNDED)


@pytest.mark.parametrize(("name", "content"), [
    ("six columns.xyz", TEXT),
    ("counted.pts", f"{len(ROWS)}\n{TEXT}"),
    ("named.csv", "nz,ny,nx,X [mm],Y [mm],Z [mm]\n"
     + "".join(",".join(map(repr, [*row[:2:-1], *row[:3]])) + "\n" for row in ROWS.tolist())),
    ("commented header.asc", "//X Y Z R Nx Ny Nz\n"
     + "".join(" ".join(map(repr, [*row[:3], 255, *row[3:]])) + "\n" for row in ROWS.tolist()))])
def test_normals_as_text(tmp_path, name, content):
    cloud = read(tmp_path, name, content)
    np.testing.assert_array_equal(cloud.points, POINTS)
    np.testing.assert_allclose(cloud.normals, NORMALS, atol=ROUNDED)


@pytest.mark.parametrize("columns", [_RANDOM.integers(0, 256, (60, 3)), _RANDOM.uniform(0, 1, (60, 3)),
                                     np.zeros((60, 3))], ids=["bytes", "shares", "nothing"])
def test_colours_are_no_normals(tmp_path, columns):
    np.savetxt(tmp_path / "s.xyz", np.hstack([POINTS, columns]))
    assert files.read(tmp_path / "s.xyz").normals is None


def test_lines_that_end_early_have_no_normals_but_are_read(tmp_path):
    cloud = read(tmp_path, "s.xyz", TEXT + "1 2 3\n")
    assert (len(cloud.points), cloud.normals) == (len(POINTS) + 1, None)


def test_triangles_tell_the_normals_of_an_stl(tmp_path):
    """Two walls of a trough: the order of the corners counts, not the normals that the file holds."""
    trough = np.array([[[0, 0, 0], [4, 0, 0], [0, 4, 0]], [[0, 0, 0], [0, 4, 0], [0, 0, 2]]], dtype="<f4")
    content = b"scan".ljust(80) + struct.pack("<I", 2)
    content += b"".join(bytes(12) + facet.tobytes() + bytes(2) for facet in trough)
    cloud = read(tmp_path, "s.stl", content)
    # Areas of 8 and 4 mm²: at the common corners the first counts twice.
    both = np.array([1, 0, 2]) / np.sqrt(5)
    np.testing.assert_allclose(cloud.points, [[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 2]])
    np.testing.assert_allclose(cloud.normals, [both, [0, 0, 1], both, [1, 0, 0]], atol=ROUNDED)


def test_a_row_without_a_normal_is_zero_and_dropped_points_take_theirs_along(tmp_path):
    rows = ROWS.copy()
    rows[3, 3:], rows[5, 0] = 0.0, np.nan
    np.savetxt(tmp_path / "s.xyz", rows)
    cloud = files.read(tmp_path / "s.xyz")
    rows = np.delete(rows, 5, axis=0)
    np.testing.assert_allclose(cloud.normals, rows[:, 3:], atol=ROUNDED)
    assert cloud.dropped == 1


def test_fused_with_a_scan_that_has_none(tmp_path):
    write_ply(tmp_path / "a.ply", POINTS[:7])
    write_ply(tmp_path / "b.ply", POINTS, NORMALS)
    cloud = files.read([tmp_path / "a.ply", tmp_path / "b.ply"], "m")
    assert not cloud.normals[:7].any()
    np.testing.assert_allclose(cloud.normals[7:], NORMALS, atol=ROUNDED)
    np.testing.assert_allclose(cloud.points[7:], 1000 * POINTS)
    assert files.read(tmp_path / "a.ply").normals is None
