# SPDX-License-Identifier: LGPL-2.1-or-later
"""LAS, LAZ and OBJ: read by libraries where they are installed, and one sentence where not."""
from __future__ import annotations

import sys

import numpy as np
import pytest

from ffds_workbench.errors import InputError
from ffds_workbench.scan import files

OFFSET = (4.5e6, 5.4e6, 100.0)
"""As of a national grid, in metres: single precision would be half a metre off."""


@pytest.fixture
def points():
    return np.round(np.random.default_rng(0).uniform(0, 100, (500, 3)), 3) + OFFSET


def _write_las(path, points):
    laspy = pytest.importorskip("laspy", reason="laspy is not installed: LAS files are not read")
    header = laspy.LasHeader(point_format=3, version="1.2")
    header.scales, header.offsets = [0.001] * 3, OFFSET
    content = laspy.LasData(header)
    content.x, content.y, content.z = points.T
    content.write(path)


@pytest.mark.parametrize("name", ["a.las", "a.laz"])
def test_las_keeps_large_coordinates(tmp_path, points, name):
    if name == "a.laz":
        pytest.importorskip("lazrs", reason="lazrs is not installed: LAZ files are not read")
    _write_las(tmp_path / name, points)
    assert np.abs(files.read(tmp_path / name).points - points).max() < 1e-8


@pytest.mark.parametrize("damage, words", [
    (lambda data: data[: len(data) // 2], "cut off"),
    (lambda data: data[:100] + b"\xff" * 4 + data[104:], "damaged"),  # four billion records before the points
    (lambda data: data[:107] + b"\xff" * 4 + data[111:], "damaged"),  # four billion points
    (lambda data: b"LASX" + data[4:], "cannot be read"), (lambda data: b"LASF", "damaged")])
def test_a_damaged_las_is_said_to_be(tmp_path, points, damage, words):
    _write_las(tmp_path / "a.las", points)
    (tmp_path / "a.las").write_bytes(damage((tmp_path / "a.las").read_bytes()))
    with pytest.raises(InputError, match=words):
        files.read(tmp_path / "a.las")


@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_obj_keeps_large_coordinates(tmp_path, points, end):
    """Vertices with colours, with polygons and materials between them that do not matter."""
    pytest.importorskip("trimesh", reason="trimesh is not installed: OBJ files are not read")
    lines = ["# a comment", "mtllib none.mtl", "o thing",
             *(f"v {x:.4f} {y:.4f} {z:.4f} 0.5 0.5 0.5" for x, y, z in points),
             "vn 0 0 1", "f 1//1 2//1 3//1 4//1 5//1"]
    (tmp_path / "a.obj").write_bytes(end.join(lines).encode())
    assert np.abs(files.read(tmp_path / "a.obj").points - points).max() < 1e-8


@pytest.mark.parametrize("text", ["v 1 2\nv 3 4\n", "f 1 2 3\n", "v a b c\n", "\0\1\2"])
def test_a_damaged_obj_is_said_to_be(tmp_path, text):
    pytest.importorskip("trimesh", reason="trimesh is not installed: OBJ files are not read")
    (tmp_path / "a.obj").write_text(text)
    with pytest.raises(InputError, match="damaged|holds no points"):
        files.read(tmp_path / "a.obj")


@pytest.mark.parametrize("name, library", [("a.las", "laspy"), ("a.laz", "laspy"), ("a.obj", "trimesh")])
def test_a_missing_library_is_named(tmp_path, monkeypatch, name, library):
    monkeypatch.setitem(sys.modules, library, None)
    (tmp_path / name).write_text("v 1 2 3\n")
    with pytest.raises(InputError, match=f"needs {library}.* not installed: install it, or save the scan as .ply"):
        files.read(tmp_path / name)
