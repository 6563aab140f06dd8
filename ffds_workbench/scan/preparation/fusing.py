# SPDX-License-Identifier: LGPL-2.1-or-later
"""Several scans with their poses become one: pairs that overlap are matched point to plane, and all pairs agreed.

Round a part, the errors of the pairs add up; the last scan overlaps the first, and the pose graph of open3d
(Choi, Zhou, Koltun 2015) shares the sum among all of them.
"""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np
from scipy.sparse.csgraph import connected_components
from scipy.spatial.transform import Rotation

from ...errors import RefusedError
from ...registration.arrays import Array
from . import library
from .spacing import spacing as spacing_of

_COARSENESS = 3.0
"""Scans are first matched with one point per cube of so many spacings."""
_REACHES = (4.0, 4.0, 4.0, 2.0, 2.0, 2.0, 1.0, 1.0, 1.0)
"""How far a point's partner may be, in cubes: at first as far as poses may be off."""
_ITERATIONS = 3
"""Iterations of ICP at each of these reaches, after which what is not held is taken back."""
_HELD = 0.05
"""Theory: where all matches push against a motion, they weigh their number; less than this share of it is no hold."""
_FINE_POINTS, _NEIGHBOURS = 5000, 16
"""Points of one scan that are matched with all of another at the end, and how many of these its normals are from."""
_OVERLAP = 0.15
"""Scans overlap where so much of one has a partner in the other."""


@dataclass(frozen=True)
class _MatchedScan:
    """A scan as open3d's clouds: one point per cube, some of its points, and all of them; the last with normals."""

    coarse: Any
    some: Any
    whole: Any


def agreed_poses(scans: Sequence[Array], names: Sequence[str]) -> list[Array]:
    """Motions (4, 4) that bring scans, each (n, 3) about where it belongs and near the origin, onto each other.

    The first scan stays.

    Raises
    ------
    RefusedError : a scan overlaps none of the others
    """
    open3d = library.open3d("fusing scans by their poses")
    cube = _COARSENESS * max(map(spacing_of, scans))
    clouds = [_scan(open3d, points, cube) for points in scans]
    graph = open3d.pipelines.registration.PoseGraph()
    graph.nodes.extend(open3d.pipelines.registration.PoseGraphNode(np.eye(4)) for _ in clouds)
    for source, target in combinations(range(len(clouds)), 2):
        found = _matched(open3d, clouds[source], clouds[target], cube)
        if found is not None:
            graph.edges.append(open3d.pipelines.registration.PoseGraphEdge(
                source, target, *found, uncertain=target != source + 1))
    _check_connected(graph, names)
    registration = open3d.pipelines.registration
    registration.global_optimization(
        graph, registration.GlobalOptimizationLevenbergMarquardt(),
        registration.GlobalOptimizationConvergenceCriteria(),
        registration.GlobalOptimizationOption(max_correspondence_distance=cube, reference_node=0))
    first = np.linalg.inv(graph.nodes[0].pose)
    return [first @ node.pose for node in graph.nodes]


def _scan(open3d: Any, points: Array, cube: float) -> _MatchedScan:
    whole = library.cloud(open3d, points)
    coarse = whole.voxel_down_sample(cube)
    for cloud in (coarse, whole):
        cloud.estimate_normals(open3d.geometry.KDTreeSearchParamKNN(_NEIGHBOURS))
    chosen = np.random.default_rng(0).permutation(len(points))[:_FINE_POINTS]
    return _MatchedScan(coarse, whole.select_by_index(chosen.tolist()), whole)


def _matched(open3d: Any, source: _MatchedScan, target: _MatchedScan, cube: float) -> tuple[Array, Array] | None:
    """The motion (4, 4) of one scan onto another and how sure it is (6, 6); None where they do not overlap."""
    registration = open3d.pipelines.registration
    to_plane = registration.TransformationEstimationPointToPlane
    few = registration.ICPConvergenceCriteria(max_iteration=_ITERATIONS)
    pose = np.eye(4)
    for reach in _REACHES:
        found = registration.registration_icp(source.coarse, target.coarse, reach * cube, pose, to_plane(), few)
        if found.fitness < _OVERLAP:
            return None
        pose, _ = _held(np.array(found.transformation), *_matches(found, target.coarse))
    robust = to_plane(registration.TukeyLoss(2.0 * found.inlier_rmse))
    for _ in range(_ITERATIONS):
        found = registration.registration_icp(source.some, target.whole, cube, pose, robust, few)
        pose, information = _held(np.array(found.transformation), *_matches(found, target.whole))
    return pose, information


def _matches(found: Any, target: Any) -> tuple[Array, Array]:
    """The points (n, 3) of the target that have a partner, and their normals."""
    pairs = np.asarray(found.correspondence_set)[:, 1]
    return np.asarray(target.points)[pairs], np.asarray(target.normals)[pairs]


def _held(pose: Array, points: Array, normals: Array) -> tuple[Array, Array]:
    """A pose (4, 4) without the motions that matches at points (n, 3) with normals do not hold, as along a plane.

    Where little holds it, a motion is noise (Zhang, Kaess and Singh 2016). Also what the matches tell of the others
    (6, 6), turns first.
    """
    centre = points.mean(axis=0)
    radius = max(float(np.sqrt(((points - centre) ** 2).sum(axis=1).mean())), 1e-12)
    rows = np.hstack([np.cross((points - centre) / radius, normals), normals])
    weights, motions = np.linalg.eigh(rows.T @ rows)
    held = motions[:, weights > _HELD * len(rows) / 3.0]
    turn = radius * Rotation.from_matrix(pose[:3, :3]).as_rotvec()
    motion = held @ held.T @ np.concatenate([turn, pose[:3, :3] @ centre + pose[:3, 3] - centre])
    result = np.eye(4)
    result[:3, :3] = Rotation.from_rotvec(motion[:3] / radius).as_matrix()
    result[:3, 3] = centre + motion[3:] - result[:3, :3] @ centre
    about_centre = np.block([[radius * np.eye(3), np.zeros((3, 3))], [np.cross(centre, np.eye(3)), np.eye(3)]])
    told = rows @ held @ held.T @ about_centre
    return result, told.T @ told


def _check_connected(graph: Any, names: Sequence[str]) -> None:
    count = len(graph.nodes)
    joined = np.eye(count)
    for edge in graph.edges:
        joined[edge.source_node_id, edge.target_node_id] = 1.0
    group = connected_components(joined, directed=False)[1]
    if group.any():
        name = names[int(np.argmax(group != group[0]))]
        raise RefusedError(f"The scan {name} does not overlap with {names[0]} or what overlaps with it: its pose is "
                           f"wrong, or the scans are of different sides; a scan between them would join them.")
