# SPDX-License-Identifier: LGPL-2.1-or-later
"""Small sound files of every kind that is read, for ``benchmark fuzz`` and the tests to damage."""
from __future__ import annotations

import struct
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from ...registration.arrays import Array

if TYPE_CHECKING:
    import Part

POINTS = 50
_PAGE, _CHECKSUM, _E57_HEADER = 1024, 4, 48


def scans() -> Mapping[str, list[bytes]]:
    """By suffix, the contents of files with a curved patch of `POINTS` points, most of them with normals."""
    random = np.random.default_rng(1)
    x, y = random.uniform(0.0, 100.0, (2, POINTS))
    points = np.stack([x, y, 5.0 * np.sin(x / 30.0)], axis=1)
    slope = np.stack([-np.cos(x / 30.0) / 6.0, np.zeros(POINTS), np.ones(POINTS)], axis=1)
    rows = np.hstack([points, slope / np.linalg.norm(slope, axis=1, keepdims=True)])
    text = "\n".join(" ".join(f"{value:.6f}" for value in row) for row in rows) + "\n"
    commas = text.replace(" ", ";").replace(".", ",")
    return {
        ".ply": [ply(rows, "ascii"), ply(rows, "binary_little_endian"), ply(rows[:, :3], "binary_big_endian")],
        ".pcd": [pcd(rows, "ascii"), pcd(rows, "binary")],
        "compressed.pcd": [pcd(rows, "binary_compressed")],
        ".stl": [stl(points), stl_text(points)],
        ".e57": [e57(points)],
        ".xyz": [text.encode()],
        ".asc": [b"# a scan\n//X Y Z Nx Ny Nz\n" + text.encode()],
        ".txt": [text.replace(" ", "\t").encode(), text.encode("utf-16")],
        ".csv": [b"x,y,z,nx,ny,nz\n" + text.replace(" ", ",").encode(), ("X;Y;Z;nx;ny;nz\r\n" + commas).encode()],
        ".pts": [f"{POINTS}\n{text}".encode()]}


def ply(rows: Array, encoding: str) -> bytes:
    """Rows (n, 3), or (n, 6) with normals, as PLY of single precision."""
    names = ("x", "y", "z", "nx", "ny", "nz")[: rows.shape[1]]
    header = "\n".join(["ply", f"format {encoding} 1.0", f"element vertex {len(rows)}",
                        *(f"property float {name}" for name in names), "element face 1",
                        "property list uchar int vertex_indices", "end_header", ""])
    if encoding == "ascii":
        return (header + "\n".join(" ".join(f"{value:.6f}" for value in row) for row in rows) + "\n3 0 1 2\n").encode()
    order = "<" if "little" in encoding else ">"
    return header.encode() + rows.astype(order + "f4").tobytes() + struct.pack(order + "B3i", 3, 0, 1, 2)


def pcd(rows: Array, encoding: str) -> bytes:
    """Rows (n, 6) of points and normals as PCD of single precision."""
    header = ("# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z normal_x normal_y normal_z\n"
              "SIZE 4 4 4 4 4 4\nTYPE F F F F F F\nCOUNT 1 1 1 1 1 1\n"
              f"WIDTH {len(rows)}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {len(rows)}\nDATA {encoding}\n").encode()
    if encoding == "ascii":
        return header + "\n".join(" ".join(f"{value:.6f}" for value in row) for row in rows).encode() + b"\n"
    if encoding == "binary":
        return header + rows.astype("<f4").tobytes()
    plain = rows.T.astype("<f4").tobytes()
    packed = lzf(plain)
    return header + struct.pack("<2I", len(packed), len(plain)) + packed


def lzf(data: bytes) -> bytes:
    """Data compressed as liblzf does it, with what was seen before as references."""
    result, literal, place = bytearray(), bytearray(), 0
    last: dict[bytes, int] = {}

    def flush() -> None:
        for start in range(0, len(literal), 32):
            piece = literal[start : start + 32]
            result.append(len(piece) - 1)
            result.extend(piece)
        literal.clear()

    while place < len(data):
        start = last.get(data[place : place + 3], -1)
        last[data[place : place + 3]] = place
        if 0 <= start and place - start <= 8192 and place + 3 <= len(data):
            length = 3
            while length < 264 and place + length < len(data) and data[start + length] == data[place + length]:
                length += 1
            flush()
            back, coded = place - start - 1, length - 2
            result.append(min(coded, 7) << 5 | back >> 8)
            result.extend([coded - 7] * (coded >= 7) + [back & 255])
            place += length
        else:
            literal.append(data[place])
            place += 1
    flush()
    return bytes(result)


def stl(corners: Array) -> bytes:
    """Triangles of three points each that follow one another, (3 m, 3), as binary STL."""
    facets = corners[: len(corners) // 3 * 3].reshape(-1, 9).astype("<f4")
    return b"a scan".ljust(80) + struct.pack("<I", len(facets)) + b"".join(
        struct.pack("<3f", 0, 0, 1) + facet.tobytes() + b"\0\0" for facet in facets)


def stl_text(corners: Array) -> bytes:
    """The same as text."""
    facets = corners[: len(corners) // 3 * 3].reshape(-1, 3, 3)
    text = "".join("facet normal 0 0 1\n outer loop\n" + "".join(f"  vertex {x:.5f} {y:.5f} {z:.5f}\n" for x, y, z in f)
                   + " endloop\nendfacet\n" for f in facets)
    return f"solid scan\n{text}endsolid scan\n".encode()


def e57(points: Array, old: str = "", new: str = "") -> bytes:
    """Points (n, 3) as E57 (ASTM E2807): z as a scaled integer of 21 bits, the others as doubles; checksums are 0.

    In the text that describes them ``old`` is replaced by ``new``.
    """
    half, scale = 1 << 20, 1e-3
    stored = np.rint(points[:, 2] / scale).astype(np.int64) + half
    streams = [points[:, 0].astype("<f8").tobytes(), points[:, 1].astype("<f8").tobytes(),
               np.packbits((stored[:, None] >> np.arange(21)) & 1, bitorder="little").tobytes()]
    body = struct.pack("<3H", *map(len, streams)) + b"".join(streams)
    body += b"\0" * (-(6 + len(body)) % 4)
    packet = struct.pack("<BBHH", 1, 0, 5 + len(body), 3) + body
    section = struct.pack("<B7x3Q", 1, 32 + len(packet), _physical(_E57_HEADER + 32), 0) + packet
    text = ('<?xml version="1.0" encoding="UTF-8"?><e57Root type="Structure" '
            'xmlns="http://www.astm.org/COMMIT/E57/2010-e57-v1.0"><data3D type="Vector"><vectorChild type="Structure">'
            f'<points type="CompressedVector" fileOffset="{_physical(_E57_HEADER)}" recordCount="{len(points)}">'
            '<prototype type="Structure"><cartesianX type="Float"/><cartesianY type="Float"/>'
            f'<cartesianZ type="ScaledInteger" minimum="{-half}" maximum="{half - 1}" scale="{scale}"/></prototype>'
            '</points><pose type="Structure"><rotation type="Structure"><w type="Float">0.6</w><x type="Float"/>'
            '<y type="Float"/><z type="Float">0.8</z></rotation></pose></vectorChild></data3D></e57Root>')
    xml = (text.replace(old, new) if old else text).encode()
    pages = -(-(_E57_HEADER + len(section) + len(xml)) // (_PAGE - _CHECKSUM))
    header = struct.pack("<8s2I4Q", b"ASTM-E57", 1, 0, pages * _PAGE, _physical(_E57_HEADER + len(section)), len(xml),
                         _PAGE)
    whole = (header + section + xml).ljust(pages * (_PAGE - _CHECKSUM), b"\0")
    return b"".join(whole[start : start + _PAGE - _CHECKSUM] + b"\0" * _CHECKSUM
                    for start in range(0, len(whole), _PAGE - _CHECKSUM))


def _physical(logical: int) -> int:
    """Where a place of an E57 file is once every page has its checksum."""
    return logical + _CHECKSUM * (logical // (_PAGE - _CHECKSUM))


def paths() -> Mapping[str, list[bytes]]:
    """By suffix, taught paths over the upper face of `plate`."""
    places = [(10.0 + 8.0 * i, 50.0 + 3.0 * np.sin(i), 0.0) for i in range(10)]
    krl = ["&ACCESS RVP", "DEF Teach( )", "$BASE={X 1,Y 2,Z 3,A 0,B 0,C 0}", "PTP {A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0}",
           *(f"LIN {{X {x:.3f}, Y {y:.3f}, Z {z:.3f}, A 10, B 0, C 180, E1 5.0}} C_DIS ; taught" for x, y, z in places),
           "LIN_REL {X 5,Y 0,Z 0}", "END", ""]
    columns = "s,x,y,z,tx,ty,tz,qx,qy,qz,qw,gap,band,flag,note"
    seam = [f"{8 * i},{x:.4f},{y:.4f},{z:.4f},1,0,0,0,1,0,0,0.1,,observed,a" for i, (x, y, z) in enumerate(places)]
    angles = [f"{x:.3f};{y:.3f};{z:.3f};10;0;180".replace(".", ",") for x, y, z in places]
    return {".src": ["\r\n".join(krl).encode("latin-1")],
            ".csv": ["\n".join([columns, *seam]).encode(), "\n".join(["X;Y;Z;A;B;C", *angles]).encode(),
                     "\n".join(f"{x}\t{y}\t{z}" for x, y, z in places).encode()]}


def measured() -> Array:
    """A scan of the upper face of `plate` with a bump of 1 mm, and its normals, (n, 6)."""
    random = np.random.default_rng(2)
    x, y = random.uniform(1.0, 99.0, (2, 4000))
    height = np.exp(-((x - 30.0) ** 2 + (y - 30.0) ** 2) / 800.0)
    up = np.tile([0.0, 0.0, 1.0], (len(x), 1))
    return np.hstack([np.stack([x, y, height + random.normal(0.0, 0.05, len(x))], axis=1), up])


def plate() -> Part.Shape:
    """A part that the scans and the paths lie on: 100 × 100 × 8 mm, its upper face at z = 0."""
    import FreeCAD
    import Part

    return Part.makeBox(100.0, 100.0, 8.0, FreeCAD.Vector(0.0, 0.0, -8.0))
