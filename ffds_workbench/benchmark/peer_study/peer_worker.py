# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs one method on one cloud in a process of its own: ``python peer_worker.py METHOD IN.npz OUT.npz SECONDS``.

A script, run with the Python of the method's environment; it imports only what the method needs. IN holds ``scan``
(n, 3) and ``size`` (2,): the nominal sheet z = 0 from (0, 0) to ``size``, in mm. OUT holds ``moved`` (m, 3), points of
the nominal sheet where the method puts them, ``seconds`` of the method alone, and ``megabytes`` it needed beyond what
the process held before.
"""
from __future__ import annotations

import resource
import sys
import time
from collections.abc import Callable

import numpy as np

Job = Callable[[], np.ndarray]
_MEMORY = 10 * 2**30
_QUICK = 5.0


def grid(size: np.ndarray, side: int) -> np.ndarray:
    """Points of the nominal sheet, (side², 3), row by row in x."""
    x, y = np.meshgrid(np.linspace(0, size[0], side), np.linspace(0, size[1], side), indexing="ij")
    return np.column_stack([x.ravel(), y.ravel(), np.zeros(side * side)])


def triangles(side: int) -> np.ndarray:
    """Triangles of that grid, (2 (side − 1)², 3)."""
    corner = np.arange(side * side).reshape(side, side)
    a, b, c, d = corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]
    return np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])


def rigid_icp(scan: np.ndarray, size: np.ndarray) -> Job:
    """open3d's point-to-plane ICP: what a user has without any deformation."""
    import open3d
    source, points = grid(size, 51), grid(size, 101)

    def job() -> np.ndarray:
        nominal = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points))
        target = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(scan))
        target.estimate_normals(open3d.geometry.KDTreeSearchParamHybrid(2.0, 30))
        estimation = open3d.pipelines.registration.TransformationEstimationPointToPlane()
        T = open3d.pipelines.registration.registration_icp(nominal, target, 8.0, np.eye(4), estimation).transformation
        return source @ T[:3, :3].T + T[:3, 3]

    return job


def spline_fit(scan: np.ndarray, size: np.ndarray) -> Job:
    """scipy's LSQBivariateSpline z(x, y) with 10 × 10 coefficients through all points."""
    from scipy.interpolate import LSQBivariateSpline
    source = grid(size, 51)

    def job() -> np.ndarray:
        inside = ((scan[:, :2] >= 0) & (scan[:, :2] <= size)).all(axis=1)
        x, y, z = scan[inside].T
        knots = [np.linspace(0, side, 8)[1:-1] for side in size]
        fit = LSQBivariateSpline(x, y, z, *knots, bbox=[0, size[0], 0, size[1]])
        return np.column_stack([source[:, :2], fit(source[:, 0], source[:, 1], grid=False)])

    return job


def thin_plate(scan: np.ndarray, size: np.ndarray) -> Job:
    """scipy's thin-plate RBFInterpolator over the 100 nearest points, smoothed."""
    from scipy.interpolate import RBFInterpolator
    source = grid(size, 51)

    def job() -> np.ndarray:
        fit = RBFInterpolator(scan[:, :2], scan[:, 2], neighbors=100, kernel="thin_plate_spline", smoothing=300.0)
        return np.column_stack([source[:, :2], fit(source[:, :2])])

    return job


def pycpd(alpha: float, beta: float, outliers: float) -> Callable[[np.ndarray, np.ndarray], Job]:
    """pycpd's deformable registration of 484 nominal points, in units of the sheet's size.

    Weights, widths and shares of outliers were tried for α 0.01 … 100, β 0.25 … 2, w 0.1 … 0.7 and 400 … 900 points.
    """

    def prepare(scan: np.ndarray, size: np.ndarray) -> Job:
        from pycpd import DeformableRegistration
        source, scale = grid(size, 22), size.max()

        def job() -> np.ndarray:
            registration = DeformableRegistration(X=scan / scale, Y=source / scale, alpha=alpha, beta=beta, w=outliers,
                                                  max_iterations=40, tolerance=1e-6)
            return registration.register()[0] * scale

        return job

    return prepare


def probreg(scan: np.ndarray, size: np.ndarray) -> Job:
    """probreg's non-rigid coherent point drift of 900 nominal points."""
    from probreg import cpd
    source, scale = grid(size, 30), size.max()

    def job() -> np.ndarray:
        result = cpd.registration_cpd(source / scale, scan / scale, "nonrigid", w=0.1, beta=0.25, lmd=1.0, maxiter=100)
        return result.transformation.transform(source / scale) * scale

    return job


def trimesh_nricp(scan: np.ndarray, size: np.ndarray) -> Job:
    """trimesh's non-rigid ICP (Amberg) of a mesh of 30 × 30 nominal points."""
    import trimesh
    source = trimesh.Trimesh(grid(size, 30), triangles(30), process=False)
    job_steps = [[0.1, 0, 0.5, 10], [0.02, 0, 0.0, 10], [0.005, 0, 0.0, 10]]

    def job() -> np.ndarray:
        return np.asarray(trimesh.registration.nricp_amberg(source, scan, steps=job_steps, distance_threshold=0.1,
                                                            use_faces=False, use_vertex_normals=False))

    return job


def ours(method: str) -> Callable[[np.ndarray, np.ndarray], Job]:
    """One of this project's methods."""

    def prepare(scan: np.ndarray, size: np.ndarray) -> Job:
        from ffds_workbench.benchmark.peer_study.peers_own import OWN
        from ffds_workbench.benchmark.simulated.sheet import nominal
        source, face = grid(size, 51), nominal()

        def job() -> np.ndarray:
            return source + OWN[method](face, scan).displacement(source[:, :2])

        return job

    return prepare


METHODS: dict[str, Callable[[np.ndarray, np.ndarray], Job]] = {
    "rigid_icp": rigid_icp, "spline_fit": spline_fit, "thin_plate": thin_plate, "pycpd": pycpd(2.0, 0.5, 0.1),
    "pycpd_outliers": pycpd(0.5, 0.7, 0.7), "probreg": probreg, "trimesh_nricp": trimesh_nricp}


def main(method: str, source: str, destination: str, seconds_at_most: str) -> None:
    """Run, measure, write."""
    resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
    resource.setrlimit(resource.RLIMIT_CPU, (int(seconds_at_most), int(seconds_at_most)))
    given = np.load(source)
    prepare = METHODS.get(method) or ours(method)
    job = prepare(np.ascontiguousarray(given["scan"]), given["size"])
    before = _kilobytes("VmRSS")
    moved, seconds = _timed(job)
    megabytes = max(0, _kilobytes("VmHWM") - before) / 1000
    if seconds < _QUICK:     # once more, with everything loaded
        moved, seconds = _timed(job)
    np.savez(destination, moved=moved, seconds=seconds, megabytes=megabytes)


def _timed(job: Job) -> tuple[np.ndarray, float]:
    """Elapsed or processor time, whichever is smaller: a busy machine or several cores must not count."""
    start, start_cpu = time.perf_counter(), time.process_time()
    moved = job()
    return moved, min(time.perf_counter() - start, time.process_time() - start_cpu)


def _kilobytes(entry: str) -> int:
    """Memory of this process by the kernel's books: VmRSS now, VmHWM at its largest."""
    with open("/proc/self/status", encoding="ascii") as lines:
        return next((int(line.split()[1]) for line in lines if line.startswith(entry)), 0)


if __name__ == "__main__":
    main(*sys.argv[1:5])
