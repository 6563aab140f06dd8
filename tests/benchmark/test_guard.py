# SPDX-License-Identifier: LGPL-2.1-or-later
"""No change anywhere loses a part unseen: the supplied cases and one of each family against the lines of the accuracy
benchmark, and a few of what is asked of the alignment, the topology and the seams. Every bound is a benchmark's."""
from __future__ import annotations

import numpy as np
import pytest

from ffds_workbench import api
from ffds_workbench.benchmark import accuracy, alignment, topology
from ffds_workbench.benchmark.accuracy_study.accuracy_lines import lines
from ffds_workbench.benchmark.simulated import topology_shapes
from ffds_workbench.benchmark.simulated.families import make_case
from ffds_workbench.benchmark.simulated.sheet import to_polyline
from ffds_workbench.benchmark.world import ScanSettings, judge
from ffds_workbench.benchmark.world.case import WorldTruth, make
from ffds_workbench.benchmark.world.shapes import lamp_mount
from ffds_workbench.errors import RefusedError
from ffds_workbench.scan.cloud import PointCloud
from ffds_workbench.scan.sensor import SensorSettings, View, simulate

SUPPLIED = ("a-iso", "b-mix", "b-mix-dirty", "b-springback", "b-springback-1view", "c-springback", "d-bumps", "e-twist",
            "f-bend")
"""All of ../shared/data/cases but for g-frame, which takes longer than all of them."""
FAMILIES = (("bracket", "springback", 0, "clean"), ("rimmed-plate", "iso", 2, "clean"),
            ("pipe-on-plate", "bumps", 4, "clean"), ("hat-channel", "mix", 7, "clean"),
            ("free-form-panel", "mix", 9, "clean"), ("turned-part", "twist", 23, "clean"))
"""Of the accuracy benchmark's own scans, whose lines for a family are those of its mean."""


def missed(rows) -> list[str]:
    """What is asked and not met."""
    return [f"{line.what}: {line.found:.4g}, {line.asked}" for line in lines({}, rows) if not line.met]


def test_the_families_are_as_accurate_as_asked():
    rows = accuracy.run_cases(FAMILIES, lambda message: None)
    assert not missed(rows), [row.get("refused") for row in rows]


def test_the_supplied_cases_are_as_accurate_as_asked(shared_data):
    rows = accuracy.run_cases(SUPPLIED, lambda message: None)
    assert not missed(rows), [row.get("refused") for row in rows]


@pytest.mark.parametrize("family, warp", [("bracket", "twist"), ("hat-channel", "bend"), ("rimmed-plate", "iso")])
def test_the_pose_of_a_deformed_part_is_found(family, warp):
    trial = alignment.deformed(family, warp, 2)
    for seed in range(2):
        found = alignment.one_start(trial, "fine", seed)
        assert not found.failed, (found.verdict, found.offset, np.rad2deg(found.turn))


@pytest.mark.parametrize("name", ["torus", "box with holes", "loft", "extruded spline", "mirrored"])
def test_shapes_keep_their_topology(name):
    rows = topology.measure(name, dict(topology_shapes.primitives())[name], lambda message: None)
    assert len(rows) == 4 and not [row for row in rows if isinstance(row, topology.Refused) or row.problems]


def test_seams_lie_where_the_edges_of_the_deformed_part_lie(tmp_path):
    """The bracket's longest edges as seams of its as-built model; its family's line for edges."""
    case = make_case(*FAMILIES[0])
    case.write(tmp_path)
    model = api.read_model(tmp_path / "nominal.step")
    result = api.register(model, api.read_scan(tmp_path / "scan.ply"))
    longest = sorted(range(len(model.shape.Edges)), key=lambda k: model.shape.Edges[k].Length)[-3:]
    plan = api.plan_seams(result.model, [f"Edge{k + 1}" for k in longest], nominal=model)
    assert len(plan.seams) == 3
    for seam in plan.seams:
        off = min((to_polyline(seam.stations.positions, case.truth.edges[k]) for k in longest), key=np.mean)
        assert off.mean() < 0.03


@pytest.mark.parametrize("family, warp", [("rimmed-plate", "iso"), ("bracket", "mix"), ("free-form-panel", "twist")])
def test_a_cloud_without_noise_is_never_written_unregistered(family, warp, tmp_path):
    """Refused, or where the scan is: its points lie on the deformed part to rounding, 2 mm from the nominal one."""
    case = make_case(family, warp, 1)
    points = simulate(case.target, SensorSettings(spacing=0.35, noise=0.0, seed=1,
                                                  views=tuple(View(tuple(view)) for view in case.part.views))).points
    case.write(tmp_path)
    try:
        result = api.register(api.read_model(tmp_path / "nominal.step"), PointCloud(points))
    except RefusedError:
        return
    before, after = result.report["deviation_before"]["mean"], result.report["deviation_after"]["mean"]
    assert after < 0.02 < 0.1 < before


def test_the_edges_of_a_lamp_mount_are_as_accurate_as_the_world_benchmark_asks(tmp_path):
    """Bent by 1.5 % and seen from four sides by a scan without normals: edges that end in poles, or are shorter than a
    cell, made the solve wander. The benchmark's line is a mean; a sixth of its points leaves √6 times as much noise."""
    mount = lamp_mount()
    make(mount, "bent-1.5", ScanSettings(views=4, points=10_000), tmp_path)
    truth = WorldTruth(**np.load(tmp_path / "truth.npz"))
    built = api.register(mount, api.read_scan(tmp_path / "scan.ply")).shape
    assert judge._figures(built, truth, np.zeros(len(truth.face)))["edges"]["mean"] < 0.05 * 6**0.5
