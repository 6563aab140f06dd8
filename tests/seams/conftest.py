# SPDX-License-Identifier: LGPL-2.1-or-later
"""Small parts whose seams are known, deformations in closed form, and the truth that both give."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import FreeCAD
import numpy as np
import Part
import pytest

from ffds_workbench.brep import workpiece
from ffds_workbench.brep.face_displacement import FaceDisplacement
from ffds_workbench.brep.rebuild import rebuild

Warp = Callable[[np.ndarray], np.ndarray]


def bumpy(points: np.ndarray) -> np.ndarray:
    """A smooth warp of 1 to 2 mm over parts of about 100 mm, not isometric."""
    x, y, z = points.T
    return points + np.stack([0.8 * np.sin(y / 25.0) + 0.01 * z, 1.2 * np.cos(x / 30.0),
                              1.5 * np.sin(x / 40.0) * np.cos(y / 35.0)], axis=1)


@dataclass(frozen=True)
class Truth:
    """The exact image of nominal stations under a warp: points, tangents and normals by its Jacobian."""

    points: np.ndarray
    tangents: np.ndarray
    n1: np.ndarray
    n2: np.ndarray

    @property
    def frames(self) -> np.ndarray:
        """x = travel, z along −(n1 + n2), y = z × x, as columns; written out, not taken from the project."""
        z = -(self.n1 + self.n2)
        z -= (z * self.tangents).sum(1, keepdims=True) * self.tangents
        z = unit(z)
        return np.stack([self.tangents, np.cross(z, self.tangents), z], axis=2)


def unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def truth_of(warp: Warp, stations) -> Truth:
    """Tangents go with the Jacobian J, normals with its inverse transposed; J by central differences (error 1e-9)."""
    h = 1e-4
    at = stations.positions
    jacobian = np.stack([(warp(at + h * axis) - warp(at - h * axis)) / (2 * h) for axis in np.eye(3)], axis=2)
    inverse = np.linalg.inv(jacobian)
    return Truth(warp(at), unit(np.einsum("nij,nj->ni", jacobian, stations.tangents)),
                 unit(np.einsum("nji,nj->ni", inverse, stations.n1)),
                 unit(np.einsum("nji,nj->ni", inverse, stations.n2)))


def degrees_between(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Angles between unit vectors (n, 3), or of the rotations between frames (n, 3, 3)."""
    if a.ndim == 3:
        cosine = 0.5 * (np.einsum("nij,nij->n", a, b) - 1.0)
        turn = np.einsum("nij,nik->njk", a, b)
        sine = np.linalg.norm(turn - turn.swapaxes(1, 2), axis=(1, 2)) / np.sqrt(8.0)
        return np.degrees(np.arctan2(sine, cosine))
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), (a * b).sum(1)))


def warped(shape: Part.Shape, warp: Warp, faces: list[int] | None = None) -> Part.Shape:
    """The shape under a warp of space; of the given faces only (a whole solid's)."""
    part = workpiece.read(shape)
    moving = range(len(part.faces)) if faces is None else faces
    return rebuild(part, {index: FaceDisplacement(lambda uv, points: warp(points) - points) for index in moving})


def numbered(*parts: Part.Shape) -> Part.Shape:
    return parts[0] if len(parts) == 1 else Part.makeCompound(list(parts))


@pytest.fixture(scope="session")
def pipe_on_plate() -> Part.Shape:
    """A tube of radius 20 and 3 mm wall on a plate whose top is z = 0: Face1–6 and Face7–10."""
    plate = Part.makeBox(80, 80, 8, FreeCAD.Vector(-40, -40, -8))
    tube = Part.makeCylinder(20, 40).cut(Part.makeCylinder(17, 40))
    return numbered(plate, tube.Solids[0])


@pytest.fixture(scope="session")
def bracket() -> Part.Shape:
    """An L of two 4 mm legs in one solid, with a hollow edge along x at y = 4, z = 4."""
    leg = Part.makeBox(70, 40, 4)
    wall = Part.makeBox(70, 4, 40)
    return leg.fuse(wall).removeSplitter().Solids[0]


def edge_at(shape: Part.Shape, point: tuple[float, float, float]) -> str:
    """Name of the edge that passes through a point."""
    vertex = Part.Vertex(*point)
    distances = [edge.distToShape(vertex)[0] for edge in shape.Edges]
    assert min(distances) < 1e-6
    return f"Edge{int(np.argmin(distances)) + 1}"


class Tools:
    """The functions above, for the tests."""

    bumpy = staticmethod(bumpy)
    truth_of = staticmethod(truth_of)
    degrees_between = staticmethod(degrees_between)
    warped = staticmethod(warped)
    edge_at = staticmethod(edge_at)


@pytest.fixture(scope="session")
def tools() -> type[Tools]:
    return Tools


@pytest.fixture(scope="session")
def as_built(pipe_on_plate: Part.Shape) -> Part.Shape:
    """The pipe on its plate, under `bumpy`."""
    return warped(pipe_on_plate, bumpy)
