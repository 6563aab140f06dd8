# SPDX-License-Identifier: LGPL-2.1-or-later
"""Every scan format, its variants, and what damaged files say. The truth is the array each file is written from."""
from __future__ import annotations

import struct
import tracemalloc
from pathlib import Path

import numpy as np
import pytest

from ffds_workbench.errors import InputError
from ffds_workbench.scan import files

# Large offset: single precision would be off by 4 µm here, so what holds doubles must be read as doubles.
POINTS = np.random.default_rng(1).uniform(-50, 50, (40, 3)) + (123456.789, 0, 0)
STRUCT = {"binary_little_endian": "<", "binary_big_endian": ">"}


def ply(points: np.ndarray, encoding: str, kind: str = "double", extra: bool = False,
        promised: int | None = None) -> bytes:
    lines = ["ply", f"format {encoding} 1.0", "comment made by a test",
             f"element vertex {len(points) if promised is None else promised}"]
    lines += [f"property {kind} {axis}" for axis in "xyz"]
    if extra:
        lines[4:4] = ["property uchar red"]
        lines += ["property float quality", "element face 1", "property list uchar int vertex_indices"]
    data = "\n".join([*lines, "end_header", ""]).encode()
    for point in points:
        if encoding == "ascii":
            row = " ".join(map(repr, map(float, point)))
            data += (f"7 {row} 0.5\n" if extra else f"{row}\n").encode()
        else:
            order, code = STRUCT[encoding], {"double": "3d", "float": "3f"}[kind]
            data += struct.pack(order + "B", 7) if extra else b""
            data += struct.pack(order + code, *point) + (struct.pack(order + "f", 0.5) if extra else b"")
    if extra:
        data += b"3 0 1 2\n" if encoding == "ascii" else struct.pack(STRUCT[encoding] + "B3i", 3, 0, 1, 2)
    return data


def pcd(points: np.ndarray, encoding: str, size: int = 8) -> bytes:
    header = (f"# .PCD v0.7\nVERSION 0.7\nFIELDS intensity x y _ z\nSIZE 4 {size} {size} 1 {size}\nTYPE F F F U F\n"
              f"COUNT 1 1 1 3 1\nWIDTH {len(points)}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {len(points)}\n"
              f"DATA {encoding}\n")
    data = header.encode()
    code = {8: "d", 4: "f"}[size]
    for x, y, z in points.tolist():
        if encoding == "ascii":
            data += f"1.5 {x!r} {y!r} 0 0 0 {z!r}\n".encode()
        else:
            data += struct.pack(f"<f2{code}3B{code}", 1.5, x, y, 0, 0, 0, z)
    return data


def read(folder: Path, name: str, content: bytes | str, unit: str = "mm"):
    path = folder / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return files.read(path, unit)


@pytest.mark.parametrize("extra", [False, True])
@pytest.mark.parametrize("encoding", ["ascii", "binary_little_endian", "binary_big_endian"])
def test_ply_keeps_double_precision(tmp_path, encoding, extra):
    np.testing.assert_array_equal(read(tmp_path, "s.ply", ply(POINTS, encoding, extra=extra)).points, POINTS)


def test_ply_in_single_precision(tmp_path):
    cloud = read(tmp_path, "s.PLY", ply(POINTS, "binary_big_endian", "float"))
    np.testing.assert_array_equal(cloud.points, POINTS.astype(np.float32))


@pytest.mark.parametrize("encoding", ["ascii", "binary"])
def test_pcd_keeps_double_precision(tmp_path, encoding):
    np.testing.assert_array_equal(read(tmp_path, "s.pcd", pcd(POINTS, encoding)).points, POINTS)


def test_compressed_pcd(tmp_path):
    open3d = pytest.importorskip("open3d")
    cloud = open3d.t.geometry.PointCloud(open3d.core.Tensor(POINTS))
    open3d.t.io.write_point_cloud(str(tmp_path / "s.pcd"), cloud, compressed=True)
    np.testing.assert_array_equal(files.read(tmp_path / "s.pcd").points, POINTS)
    content = (tmp_path / "s.pcd").read_bytes()
    with pytest.raises(InputError, match="cut off"):
        read(tmp_path, "t.pcd", content[: len(content) - 40])


TEXTS = {
    "blank.xyz": ("1.5 2.5 3.5\n4 5 6\n", 0),
    "tab and intensity.asc": ("# cloud\n1.5\t2.5\t3.5\t77\n4\t5\t6\t78\n", 0),
    "comma.csv": ("x,y,z\n1.5,2.5,3.5\n4,5,6\n", 0),
    "comma and blank.txt": ("1.5, 2.5, 3.5\n4, 5, 6\n", 0),
    "decimal comma.csv": ("X;Y;Z\r\n1,5;2,5;3,5\r\n4;5;6\r\n", 0),
    "decimal comma and tab.txt": ("1,5\t2,5\t3,5\n4,0\t5,0\t6,0\n", 0),
    "named columns.csv": ('"id","Z [mm]","Y [mm]","X [mm]"\n1,3.5,2.5,1.5\n2,6,5,4\n', 0),
    "commented header.asc": ("//Y X Z I\n2\n2.5 1.5 3.5 9\n5 4 6 9\n", 0),
    "count.pts": ("2\n1.5 2.5 3.5 -1200 10 20 30\n4 5 6 -900 1 2 3\n", 0),
    "no count.pts": ("1.5 2.5 3.5\n4 5 6\n", 0),
    "bom.csv": ("\ufeffx;y;z\n1.5;2.5;3.5\n4;5;6\n", 0),
    "gaps.csv": ("x;y;z\n1.5;2.5;3.5\n;;\n-;-;-\n4;5;6\n", 2),
    "nan.xyz": ("nan nan nan\n1.5 2.5 3.5\ninf 1 2\n4 5 6\n", 2),
    "quoted.csv": ('"1.5","2.5","3.5"\n"4","5","6"\n', 0),
}


@pytest.mark.parametrize("name", TEXTS)
def test_text(tmp_path, name):
    content, dropped = TEXTS[name]
    cloud = read(tmp_path, name, content)
    np.testing.assert_array_equal(cloud.points, [[1.5, 2.5, 3.5], [4, 5, 6]])
    assert cloud.dropped == dropped


def test_reading_stl_takes_memory_for_its_corners(tmp_path):
    """Of a facet's 50 bytes: itself, its corners twice while they are sorted, and two numbers for each of them."""
    facets = np.zeros(200_000, np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")]))
    facets["corners"] = np.random.default_rng(1).integers(0, 9, (len(facets), 3, 3))
    path = tmp_path / "large.stl"
    path.write_bytes(b"a scan".ljust(80) + struct.pack("<I", len(facets)) + facets.tobytes())
    tracemalloc.start()
    files.read(path)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 5 * path.stat().st_size


def test_stl_corners_are_merged(tmp_path):
    corners = np.array([[[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0], [0, 1, 0]]], dtype="<f4")
    binary = b"solid but binary".ljust(80) + struct.pack("<I", 2)
    binary += b"".join(struct.pack("<3f", 0, 0, 1) + facet.tobytes() + b"\0\0" for facet in corners)
    text = "solid x\n" + "".join(
        "facet normal 0 0 1\n outer loop\n" + "".join(f"  vertex {x} {y} {z}\n" for x, y, z in facet)
        + " endloop\nendfacet\n" for facet in corners) + "endsolid x\n"
    for name, content in (("binary.stl", binary), ("text.stl", text)):
        np.testing.assert_array_equal(read(tmp_path, name, content).points,
                                      [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]])
    for content in (binary[:-20], text[: len(text) // 2].encode(), b"some other text that is long enough" * 4):
        with pytest.raises(InputError):
            read(tmp_path, "cut.stl", content)


@pytest.mark.parametrize(("unit", "factor"), [("mm", 1), ("cm", 10), ("in", 25.4), ("m", 1000)])
def test_units(tmp_path, unit, factor):
    cloud = read(tmp_path, "s.xyz", "0 0 0\n1 2 3\n", unit)
    np.testing.assert_allclose(cloud.points[1], np.array([1, 2, 3]) * factor, rtol=1e-15)
    assert cloud.unit == unit


def test_several_scans_are_fused(tmp_path):
    read(tmp_path, "a.xyz", "0 0 0\nnan 1 1\n1 0 0\n")
    read(tmp_path, "b.ply", ply(POINTS, "ascii"))
    cloud = files.read([tmp_path / "a.xyz", tmp_path / "b.ply"])
    assert (len(cloud.points), cloud.dropped) == (2 + len(POINTS), 1)


BAD = {
    "missing.ply": (None, "does not exist"),
    "folder.ply": ("folder", "is a folder"),
    "empty.ply": (b"", "is empty"),
    "unknown.dxf": (b"1 2 3", "unknown format"),
    "cut binary.ply": (ply(POINTS, "binary_little_endian")[:-30], "promises 40 points, 38 are there"),
    "cut text.ply": (ply(POINTS, "ascii")[:-20], "promises 40 points, 39 are there"),
    "short.ply": (ply(POINTS, "binary_big_endian", promised=99), "promises 99 points, 40 are there"),
    "header only.ply": (b"ply\nformat ascii 1.0\nelement vertex 5\n", "header is cut off"),
    "garbage.ply": (b"hello world\n", "not a PLY"),
    "no points.ply": (ply(POINTS[:0], "ascii"), "holds no points"),
    "cut binary.pcd": (pcd(POINTS, "binary")[:-5], "promises 40 points, 39 are there"),
    "cut text.pcd": (pcd(POINTS, "ascii")[:-30], "promises 40 points, 39 are there"),
    "garbage.pcd": (b"hello world\n", "not a PCD"),
    "letter.txt": (b"Dear Sir,\nplease find enclosed\n", "not a text file of points"),
    "word.xyz": (b"1 2 3\n1 two 3\n", "line 2 has 'two'"),
    "short row.xyz": (b"1 2 3\n1 2\n", "line 2 has fewer than 3"),
    "cut.pts": (b"5\n1 2 3\n4 5 6\n", "promises 5 points, 2 are there"),
    "binary.xyz": (b"\x00\x01\x02", "binary data"),
    "one.xyz": (b"1 2 3\n", "a single point"),
    "same.xyz": (b"1 2 3\n1 2 3\n1 2 3\n", "all its 3 points are the same"),
    "nan.xyz": (b"nan nan nan\nnan nan nan\n", "2 rows are not finite"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_files_say_what_is_wrong(tmp_path, name):
    content, message = BAD[name]
    path = tmp_path / name
    if content == "folder":
        path.mkdir()
    elif content is not None:
        path.write_bytes(content)
    with pytest.raises(InputError, match=message) as caught:
        files.read(path)
    assert "\n" not in str(caught.value) and str(path) in str(caught.value)


def test_unknown_unit(tmp_path):
    with pytest.raises(InputError, match="'feet' is unknown"):
        read(tmp_path, "s.xyz", "0 0 0\n1 2 3\n", "feet")


def test_the_real_scans_are_read_whole(shared_data):
    counts = {"scans/drilled_plate.pcd": 74983, "scans/curved_panel_mesh.ply": 29768,
              "weld_pipe_on_angle/scan_robot_laser_60deg.pcd": 3131}
    for name, count in counts.items():
        assert len(files.read(shared_data / name, "m").points) == count
