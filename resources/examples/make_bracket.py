# SPDX-License-Identifier: LGPL-2.1-or-later
"""Makes the example: a bent sheet-metal bracket with holes, and a scan of it as it came out of the welding fixture.

Run it with ``PYTHONPATH=. /usr/bin/python3 resources/examples/make_bracket.py`` to write ``bracket.step`` and
``bracket_scan.ply`` anew; the seed makes the points the same every time. The deformation is a formula of its own and
knows nothing of control lattices.
"""
from __future__ import annotations

from pathlib import Path

import numpy as np

from ffds_workbench import find_freecad

find_freecad.activate()

import FreeCAD
import Part

from ffds_workbench.brep.model_files import model_file
from ffds_workbench.brep.model_files.step_colours import Decoration

FOLDER = Path(__file__).resolve().parent
LENGTH, WIDTH, HEIGHT, THICKNESS, RADIUS = 110.0, 70.0, 55.0, 3.0, 4.0
NOISE = 0.08
SPACING = 0.45
SEED = 7
CAMERAS = np.array([[0.25, -0.62, -0.74], [-0.45, -0.75, -0.49]])
STEEL, ACCENT = (0.62, 0.66, 0.72, 0.0), (0.85, 0.45, 0.15, 0.0)


def nominal() -> Part.Shape:
    """An L-shaped sheet: base in z = 0, flange in y = 0, two slots and four holes; the outer side faces −y and −z."""
    vector = FreeCAD.Vector
    box = Part.makeBox(LENGTH, WIDTH, HEIGHT)
    inside = Part.makeBox(LENGTH, WIDTH, HEIGHT, vector(0, THICKNESS, THICKNESS))
    profile = box.cut(inside)
    profile = _rounded(profile, vector(LENGTH / 2, 0, 0), RADIUS + THICKNESS)
    profile = _rounded(profile, vector(LENGTH / 2, THICKNESS, THICKNESS), RADIUS)
    cutters = [Part.makeCylinder(5, 20, vector(x, y, -5), vector(0, 0, 1)) for x, y in ((22, 50), (88, 50))]
    cutters += [Part.makeCylinder(9, 20, vector(55, -5, 34), vector(0, 1, 0)),
                Part.makeCylinder(3, 20, vector(20, -5, 40), vector(0, 1, 0)),
                Part.makeCylinder(3, 20, vector(90, -5, 40), vector(0, 1, 0))]
    slot = Part.makeBox(24, 8, 20, vector(43, 32, -5))
    return profile.cut(Part.makeCompound([*cutters, slot]))


def _rounded(shape: Part.Shape, near: FreeCAD.Vector, radius: float) -> Part.Shape:
    edge = min(shape.Edges, key=lambda item: (item.CenterOfMass - near).Length)
    return shape.makeFillet(radius, [edge])


def deformation(points: np.ndarray) -> np.ndarray:
    """Displacement in mm of points (n, 3): the flange springs back, the base twists and bulges between the welds."""
    x, y, z = points.T
    opening = np.radians(1.6) * (0.7 + 0.3 * x / LENGTH)
    twist = np.radians(1.2) * (x / LENGTH - 0.5)
    bulge = 1.1 * np.exp(-((x - 60) ** 2 + (y - 42) ** 2) / (2 * 17.0**2))
    flange = z**2 / (z + 12.0)
    base = y**2 / (y + 12.0)
    return np.stack([0.0 * x, -opening * flange, twist * base - bulge * np.exp(-z / 30.0)], axis=1)


def scan(shape: Part.Shape) -> np.ndarray:
    """Points (n, 3) on the deformed outer side as two cameras see it: noise along the view, holes and a shadow."""
    random = np.random.default_rng(SEED)
    clouds = []
    for face in shape.Faces:
        points, normals = _samples(face, random)
        if len(points) == 0 or _is_hole_wall(face):
            continue
        for camera in CAMERAS:
            seen = (normals @ camera > 0.25) & (random.random(len(points)) < 0.5)
            deformed = points[seen] + deformation(points[seen])
            clouds.append(deformed + random.normal(0.0, NOISE, (len(deformed), 1)) * camera)
    cloud = np.concatenate(clouds)
    glare = np.linalg.norm(cloud - (85.0, 22.0, 0.0), axis=1) < 7.0
    cable = np.abs(cloud @ np.array([0.8, 0.0, 0.6]) - 34.0) < 1.6
    cloud = cloud[~glare & ~(cable & (cloud[:, 1] < 3.0))]
    dust = random.uniform((-5, -8, -8), (115, 75, 60), (120, 3))
    return np.concatenate([cloud, dust])


def _is_hole_wall(face: Part.Face) -> bool:
    return isinstance(face.Surface, Part.Cylinder) and face.Surface.Radius not in (RADIUS, RADIUS + THICKNESS)


def _samples(face: Part.Face, random: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Uniform random points on a face and its outward normals, from fine triangles."""
    vertices, triangles = face.tessellate(0.005)
    corners = np.array([tuple(vertex) for vertex in vertices])[np.array(triangles)]
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(cross, axis=1) / 2
    count = int(area.sum() / SPACING**2)
    chosen = random.choice(len(area), count, p=area / area.sum())
    a, b = random.random((2, count, 1))
    a, b = np.where(a + b > 1, 1 - a, a), np.where(a + b > 1, 1 - b, b)
    first, second, third = corners[chosen].swapaxes(0, 1)
    return first + a * (second - first) + b * (third - first), (cross / (2 * area[:, None]))[chosen]


def write_ply(path: Path, points: np.ndarray) -> None:
    """Binary PLY in single precision."""
    header = (f"ply\nformat binary_little_endian 1.0\ncomment FFDS example, mm\nelement vertex {len(points)}\n"
              "property float x\nproperty float y\nproperty float z\nend_header\n")
    path.write_bytes(header.encode() + points.astype("<f4").tobytes())


def main() -> None:
    """Write both files."""
    shape = nominal()
    colours = tuple(ACCENT if _is_hole_wall(face) else STEEL for face in shape.Faces)
    model_file.write(model_file.Model(shape, "Bracket", Decoration(colours=colours)), FOLDER / "bracket.step")
    write_ply(FOLDER / "bracket_scan.ply", scan(shape))


if __name__ == "__main__":
    main()
