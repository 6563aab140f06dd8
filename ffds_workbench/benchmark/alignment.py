# SPDX-License-Identifier: LGPL-2.1-or-later
"""How reliably a scan is brought onto the part: random start poses, deformed and cropped scans, a table, other parts.

A failure is a pose more than 1 mm or 0.5° from the truth; for a deformed part, from the pose that fits the deformed
truth best in the least squares, each point against its own face.
"""
from __future__ import annotations

import json
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import open3d as o3d
import Part
from FreeCAD import Vector
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from .. import ROOT
from ..brep import workpiece
from ..brep.simulation import target_of as sensor_target_of
from ..registration.rigid import AMBIGUOUS, FAILED, Target, align, target_of
from ..registration.rigid.fine import gauss_newton
from ..registration.rigid.motions import angle, apply, motion, shift, step
from ..scan.sensor import SensorSettings, View, simulate
from .families import make_case
from .page import Section, Table, write

Array = np.ndarray
_FAMILIES = ("bracket", "rimmed-plate", "hat-channel", "pipe-on-plate", "free-form-panel")
_FAR, _TURNED = 1.0, np.deg2rad(0.5)
_POINTS = 360_000


@dataclass(frozen=True)
class Trial:
    """A scan in the part's frame with the pose that an alignment must find, (4, 4)."""

    name: str
    target: Target
    scan: Array
    truth: Array


def run(folder: Path, progress: Callable[[str], None], starts: int = 20) -> str:
    """Measure; writes alignment.json, .md and .html into the folder and returns the tables as Markdown."""
    rows, data = [], {}
    trials = list(_trials(progress))
    for trial in trials:
        for mode in ("fine", "global"):
            progress(f"Aligning: {trial.name}, {mode}")
            row = _repeat(trial, mode, starts)
            data[f"{trial.name}, {mode}"] = row
            rows.append([trial.name, mode, f"{row['failures']} of {starts}", f"{row['ambiguous']}",
                         f"{row['median_mm']:.3f}", f"{row['worst_mm']:.3f}", f"{row['worst_deg']:.2f}",
                         f"{row['median_s']:.2f}", f"{row['median_in_downsamplings']:.1f}"])
    poses = Table("Poses from random starts", (
        "scan", "mode", "failures", "ambiguous", "median mm", "worst mm", "worst °", "median s",
        "in voxel downsamplings"), rows)
    alarms, data["other_parts"] = _other_parts(trials, progress)
    tables = [poses, alarms]
    real = ROOT.parent / "shared" / "data" / "weld_pipe_on_angle"
    if real.is_dir():
        table, data["real_weld_part"] = _real(real, starts, progress)
        tables.append(table)
    return write(folder, "alignment", "Rigid alignment", [Section("Rigid alignment", tables=tables)], data)


def _trials(progress: Callable[[str], None]) -> list[Trial]:
    trials = []
    for family in _FAMILIES:
        progress(f"Scanning: {family}")
        for name, amplitude in (("rigid", 0.0), ("deformed by 5 mm", 5.0)):
            case = make_case(family, "bend", 1, amplitude=amplitude)
            target = target_of(case.target.faces)
            scan = _resampled(case.scan.points, np.random.default_rng(1))
            truth = np.eye(4) if amplitude == 0 else best_pose(target, case.truth)
            trials.append(Trial(f"{family}, {name}", target, scan, truth))
            if amplitude == 0:
                keep = scan[:, 0] + 0.4 * scan[:, 1]
                trials.append(Trial(f"{family}, 25 % cropped", target, scan[keep < np.quantile(keep, 0.75)], np.eye(4)))
                up = case.part.views.mean(axis=0)
                trials.append(Trial(f"{family}, table with 60 %", target, _on_table(scan, target, up), np.eye(4)))
    return [*trials, _symmetric()]


def best_pose(target: Target, truth: object, iterations: int = 8) -> Array:
    """The pose that fits the truth's visible points best, each against its own face, from where they correspond."""
    visible = truth.visible.astype(bool)
    points, nominal, face = truth.warped[visible], truth.nominal[visible], truth.face[visible]
    middle, goal = points.mean(axis=0), nominal.mean(axis=0)
    rotation = Rotation.align_vectors(nominal - goal, points - middle)[0].as_matrix()
    pose = motion(rotation, goal - rotation @ middle)
    mine = {k: np.flatnonzero(target.samples.face == k) for k in np.unique(face)}
    trees = {k: cKDTree(target.samples.points[index]) for k, index in mine.items() if len(index)}
    chosen = np.isin(face, list(trees))
    points, face = points[chosen], face[chosen]
    for _ in range(iterations):
        moved = apply(pose, points)
        nearest = np.empty(len(points), dtype=np.intp)
        for k, tree in trees.items():
            nearest[face == k] = mine[k][tree.query(moved[face == k])[1]]
        height, normal = target.heights(moved, nearest)
        pose = step(gauss_newton(moved - target.centre, normal, height, np.ones(len(points)), target.size),
                    target.centre) @ pose
    return pose


def _resampled(scan: Array, rng: np.random.Generator) -> Array:
    """As many points as a stereo camera's shot, drawn with a jitter of half the scan's noise."""
    chosen = scan[rng.integers(0, len(scan), _POINTS)]
    return chosen + rng.normal(0.0, 0.06, chosen.shape)


def _on_table(scan: Array, target: Target, up: Array, share: float = 0.6) -> Array:
    """The scan with a table under the part that carries a share of all points and lies in the part's shadow nowhere."""
    rng = np.random.default_rng(2)
    up = up / np.linalg.norm(up)
    across = np.linalg.svd(up[None])[2][1:]
    count = int(len(scan) * share / (1.0 - share))
    place = target.centre @ across.T + rng.uniform(-1.0, 1.0, (3 * count, 2)) * target.size
    shadow = cKDTree(target.samples.points @ across.T).query(place, distance_upper_bound=target.spacing)[0]
    place = place[~np.isfinite(shadow)][:count]
    height = (target.samples.points @ up).min() + rng.normal(0.0, 0.13, len(place))
    return np.concatenate([scan, place @ across + height[:, None] * up])


def _symmetric() -> Trial:
    """A channel that a turn by 180° maps onto itself."""
    shape = Part.makeBox(100, 40, 25).cut(Part.makeBox(100, 34, 22, Vector(0, 3, 3)))
    for x in (20, 80):
        shape = shape.cut(Part.makeCylinder(5, 10, Vector(x, 20, -2)))
    part = workpiece.read(shape)
    views = (View((0.3, 0.2, 1.0)), View((-0.4, -0.5, 0.8)))
    scan = simulate(sensor_target_of(shape), SensorSettings(spacing=0.3, views=views, seed=3)).points
    target = target_of([part.geometry(k) for k in range(len(part.faces))])
    return Trial("channel, symmetric by 180°", target, _resampled(scan, np.random.default_rng(3)), np.eye(4))


def random_start(scan: Array, mode: str, rng: np.random.Generator) -> Array:
    """A motion of the scan: any for "global", 30° and 50 mm about its centroid for "fine"; (4, 4)."""
    middle = scan.mean(axis=0)
    if mode == "global":
        rotation = Rotation.random(random_state=int(rng.integers(2**31))).as_matrix()
        return motion(rotation, rng.uniform(-500, 500, 3))
    axis, direction = (v / np.linalg.norm(v) for v in rng.normal(size=(2, 3)))
    rotation = Rotation.from_rotvec(np.deg2rad(30) * axis).as_matrix()
    return motion(rotation, middle - rotation @ middle + 50.0 * direction)


def _repeat(trial: Trial, mode: str, starts: int) -> dict[str, float]:
    shifts, turns, seconds, ratios, failures, ambiguous = [], [], [], [], 0, 0
    for seed in range(starts):
        moved = random_start(trial.scan, mode, np.random.default_rng(seed))
        scan = apply(moved, trial.scan)
        begin = time.perf_counter()
        found = align(trial.target, scan, mode, seed=seed)
        seconds.append(time.perf_counter() - begin)
        ratios.append(seconds[-1] / _downsampling(scan))
        poses = [pose.T_model_scan @ moved for pose in found.poses]
        away = [(float(shift(pose, trial.truth, trial.target.centre)), float(angle(pose, trial.truth)))
                for pose in poses]
        far, turned = min(away, key=lambda pair: pair[0] / _FAR + pair[1] / _TURNED, default=(np.inf, np.pi))
        failures += found.verdict == FAILED or far > _FAR or turned > _TURNED
        ambiguous += found.verdict == AMBIGUOUS
        shifts.append(far)
        turns.append(np.rad2deg(turned))
    return {"failures": int(failures), "ambiguous": int(ambiguous), "median_mm": float(np.median(shifts)),
            "worst_mm": float(np.max(shifts)), "worst_deg": float(np.max(turns)), "median_s": float(np.median(seconds)),
            "median_in_downsamplings": float(np.median(ratios))}


def _downsampling(scan: Array) -> float:
    """Seconds that open3d takes to downsample the cloud to 1.5 mm voxels and to estimate normals."""
    cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(scan))
    begin = time.perf_counter()
    cloud.voxel_down_sample(1.5).estimate_normals()
    return time.perf_counter() - begin


def _other_parts(trials: list[Trial], progress: Callable[[str], None]) -> tuple[Table, dict[str, str]]:
    """Scans of other parts against each target."""
    rigid = [trial for trial in trials if trial.name.endswith("rigid")]
    rows, data = [], {}
    for number, trial in enumerate(rigid):
        for other in (rigid[number - 1], rigid[number - 2]):
            progress(f"Aligning: {other.name} on {trial.name}")
            moved = random_start(other.scan, "global", np.random.default_rng(number))
            verdict = align(trial.target, apply(moved, other.scan), "global", seed=number).verdict
            data[f"{other.name} on {trial.name}"] = verdict
            rows.append([trial.name, other.name, verdict])
    return Table("Scans of other parts", ("model", "scan", "verdict"), rows), data


def _real(folder: Path, seeds: int, progress: Callable[[str], None]) -> tuple[Table, dict[str, float]]:
    """The real weld part: the raw scan in metres against the pose that comes with it."""
    shape = Part.Shape()
    shape.read(str(folder / "nominal.step"))
    part = workpiece.read(shape)
    faces = [part.geometry(k) for k in range(len(part.faces))]
    target = target_of(faces)
    dense = cKDTree(target_of(faces, 250_000).samples.points)
    raw = np.asarray(o3d.io.read_point_cloud(str(folder / "scan_robot_laser_60deg.pcd")).points)
    known = np.array(json.loads((folder / "pose.json").read_text())["T_model_scan_mm"])

    def quality(pose: Array) -> tuple[float, float]:
        distance = dense.query(apply(pose, 1000.0 * raw))[0]
        near = distance < 4.0
        return float(near.mean()), float(np.sqrt(np.mean(distance[near] ** 2)))

    progress("Aligning: the real weld part")
    fitness, rmse = quality(known)
    found = [align(target, raw, "global", seed=seed) for seed in range(seeds)]
    got = [quality(answer.T_model_scan) for answer in found]
    good = sum(f >= fitness and r <= 1.05 * rmse and answer.unit == "m" and answer.verdict != FAILED
               for (f, r), answer in zip(got, found, strict=True))
    worst = (min(f for f, _ in got), max(r for _, r in got))
    rows = [["pose that comes with it", f"{fitness:.4f}", f"{rmse:.3f}", ""],
            ["worst of ours", f"{worst[0]:.4f}", f"{worst[1]:.3f}", f"{good} of {seeds} hold"]]
    data = {"good": good, "fitness": worst[0], "rmse": worst[1], "fitness_known": fitness, "rmse_known": rmse}
    return Table("Raw scan of a real weld part", ("pose", "fitness within 4 mm", "rmse mm", ""), rows), data
