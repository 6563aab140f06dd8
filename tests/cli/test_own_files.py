# SPDX-License-Identifier: LGPL-2.1-or-later
"""What was written as STEP is taken by seams, carry and deviation: real parts with edges and faces turned."""
from __future__ import annotations

import csv

import numpy as np
import Part
import pytest

from ffds_workbench.benchmark.simulated import topology_shapes
from ffds_workbench.brep import topology, workpiece
from ffds_workbench.brep.model_files import model_file
from ffds_workbench.brep.model_files.model_file import Model
from ffds_workbench.brep.rebuild import rebuild


@pytest.mark.parametrize("name", ["so_WaveShare_Mounting_Plate_SO101.step", "occ_bug32745_pmi1.stp"])
def test_own_files_are_taken(shared_data, ffds, tmp_path, name):
    source = shared_data / "world" / name
    nominal = Part.read(str(source))
    part = workpiece.read(nominal)
    built = rebuild(part, topology_shapes.warp(part), 1e-5)
    model_file.write(Model(built, "part"), tmp_path / "built.step")
    at = np.linspace(0.1, 0.9, 4)
    before, after = ([topology.points_on_edge(edge, at) for edge in shape.Edges] for shape in (nominal, built))
    edges = [edge for edge, faces in enumerate(topology.read(nominal).edge_faces) if len(faces) == 2]
    edges = sorted(edges, key=lambda index: -nominal.Edges[index].Length)[:6]
    far = max(np.linalg.norm(one - other, axis=1).max() for one, other in zip(before, after, strict=True))
    done = ffds("seams", "built.step", "--nominal", source, "--edge", f"Edge{edges[0] + 1}", "--out", "weld.csv",
                "--keep-failing")
    assert done.returncode == 0, done.stderr
    with (tmp_path / "weld.csv").open() as stream:
        offsets = np.array([[float(row[key]) for key in ("lateral", "normal", "longitudinal")]
                            for row in csv.DictReader(stream)])
    assert np.linalg.norm(offsets, axis=1).max() < 1.05 * far  # mirrored stations would be an edge's length apart
    points = np.concatenate([before[edge] for edge in edges])
    rows = "\n".join(",".join(f"{value:.9f}" for value in (*point, 0, 0, 180)) for point in points)
    (tmp_path / "taught.csv").write_text(f"x,y,z,a,b,c\n{rows}\n")
    done = ffds("carry", source, "built.step", "taught.csv", "--out", "new.csv")
    assert done.returncode == 0, done.stderr
    carried = np.genfromtxt(tmp_path / "new.csv", delimiter=",", names=True)
    moved = np.stack([carried[axis] for axis in "xyz"], axis=1)
    # Poses are written to a micrometre; where edges meet one may be held by another edge.
    assert np.median(np.linalg.norm(moved - np.concatenate([after[edge] for edge in edges]), axis=1)) < 1e-3
    np.savetxt(tmp_path / "scan.xyz", np.concatenate([np.array([tuple(p) for p in face.tessellate(0.5)[0]])
                                                      for face in built.Faces]))
    done = ffds("deviation", "built.step", "scan.xyz", "--report", "deviation.json")
    assert done.returncode == 0, done.stderr
