# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the joint solve refuses: every reason by itself, one sentence each, and no result."""
from dataclasses import replace

import numpy as np
import pytest

FreeCAD = pytest.importorskip("FreeCAD")
import Part

from ffds_workbench.brep.joint_part import joint_part
from ffds_workbench.brep.workpiece import read
from ffds_workbench.errors import RefusedError
from ffds_workbench.registration.joint import JointSettings, register_joint
from ffds_workbench.registration.joint.outcome import refuse_unsound, torn_faces
from ffds_workbench.registration.joint.problem import make_problem
from ffds_workbench.registration.joint.iteration import gauss_newton_step, start

SIZE, THICKNESS = (40.0, 30.0), 3.0


@pytest.fixture(scope="module")
def part():
    return joint_part(read(Part.makeBox(*SIZE, THICKNESS)))


@pytest.fixture(scope="module")
def scan():
    random = np.random.default_rng(0)
    return np.column_stack([random.uniform(0, SIZE, (6000, 2)), THICKNESS + random.normal(0, 0.05, 6000)])


@pytest.fixture(scope="module")
def solved(part, scan):
    """A problem, and a state that nothing is wrong with."""
    problem = make_problem(part, scan, JointSettings(), {})
    state = start(problem)
    count = np.full(problem.distance.size, 5.0)
    state = replace(state, last_step=0.01, values=replace(state.values, count=count))
    refuse_unsound(problem, state)
    return problem, state


def test_too_few_points(part, scan):
    with pytest.raises(RefusedError, match="only 49 points"):
        register_joint(part, scan[:49])


def test_no_overlap(part, scan):
    with pytest.raises(RefusedError, match="align it first"):
        register_joint(part, scan + [500.0, 0.0, 0.0])


def test_a_scan_of_metres(part, scan):
    with pytest.raises(RefusedError, match="extends over only 0.0.* mm of a part of 50 mm: check its unit"):
        register_joint(part, scan / 1000)


def test_everything_frozen(part, scan):
    frozen = replace(part, frozen=frozenset(range(len(part.faces))))
    with pytest.raises(RefusedError, match="Every face is frozen"):
        register_joint(frozen, scan)


def test_only_frozen_faces_are_seen(part, scan):
    top = next(k for k, face in enumerate(part.faces) if face.surface.control_points[..., 2].min() > THICKNESS - 1e-9)
    with pytest.raises(RefusedError, match="near faces that may move"):
        register_joint(replace(part, frozen=frozenset([top])), scan)


def test_points_that_lie_elsewhere(solved):
    problem, state = solved
    few = np.zeros_like(state.values.count)
    few[0] = 49
    with pytest.raises(RefusedError, match="Only 49 of 6000 scan points lie near the part"):
        refuse_unsound(problem, replace(state, values=replace(state.values, count=few)))


def test_a_displacement_larger_than_the_part(solved):
    problem, state = solved
    with pytest.raises(RefusedError, match="80 mm, is larger than the part .49 mm.: align"):
        refuse_unsound(problem, replace(state, control_points=state.control_points + [80.0, 0.0, 0.0]))


def test_no_convergence(solved):
    problem, state = solved
    steps = np.full(len(problem.part.faces), 0.1)
    steps[2] = 0.6
    with pytest.raises(RefusedError, match="did not converge .the last step moved Face3 by 0.60 mm"):
        refuse_unsound(problem, replace(state, last_step=0.6, face_steps=steps))


def test_a_face_that_folds_over(part, solved):
    problem, state = solved
    top = next(k for k, face in enumerate(part.faces) if face.surface.control_points[..., 2].min() > THICKNESS - 1e-9)
    lattice = problem.lattices.faces[top]
    folded = state.control_points.copy()
    own = folded[lattice.first_control : lattice.first_control + np.prod(lattice.shape)].reshape(*lattice.shape, 3)
    # Every second row of control points 15 mm back and forth along u: farther than the rows are apart.
    axis = int(np.argmax(np.abs(np.diff(part.faces[top].surface.control_points[:, 0], axis=0)[0])))
    own[::2, :, axis] += 15.0
    own[1::2, :, axis] -= 15.0
    with pytest.raises(RefusedError, match=f"{part.faces[top].name} would fold over"):
        refuse_unsound(problem, replace(state, control_points=folded))


def test_a_face_that_does_not_follow_its_points(part, scan):
    """The upper face of the plate 0.8 mm below the points that show it: sixteen times their noise. Five times pass:
    real scanners have noise that neighbouring points share, and that their statistics miss."""
    for lifted, refused in ((0.8, True), (0.25, False)):
        problem = make_problem(part, scan + [0.0, 0.0, lifted], JointSettings(), {})
        state = start(problem)
        count = np.full(problem.distance.size, 5.0)
        state = replace(state, last_step=0.01, values=replace(state.values, count=count))
        if refused:
            with pytest.raises(RefusedError, match=r"leaves Face\d off its scan points, by 0\.8\d* mm.*--face"):
                refuse_unsound(problem, state)
        else:
            refuse_unsound(problem, state)


def test_a_body_that_moved_farther_than_the_rest(scan):
    """A block of 8 × 8 mm beside the plate whose top lies 1.2 mm higher than the model's, beyond six times the noise:
    its points are nothing else's, and no result may leave them beside it."""
    block = Part.makeBox(8, 8, THICKNESS, FreeCAD.Vector(50, 10, 0))
    part = joint_part(read(Part.Compound([Part.makeBox(*SIZE, THICKNESS), block])))
    random = np.random.default_rng(4)
    top = np.column_stack([random.uniform([50, 10], [58, 18], (320, 2)), THICKNESS + 1.2 + random.normal(0, 0.05, 320)])
    with pytest.raises(RefusedError, match="leaves Face12 off its scan points, by 1.2 mm"):
        register_joint(part, np.vstack([scan, top]))


def test_a_small_face_that_wanders_is_carried(scan):
    """A boss of 4 × 4 mm on the plate: it may wander, a whole side may not; without its points the rest goes on."""
    boss = Part.makeBox(4, 4, 5, FreeCAD.Vector(18, 13, THICKNESS))
    part = joint_part(read(Part.makeBox(*SIZE, THICKNESS).fuse(boss).removeSplitter().Solids[0]))
    problem = make_problem(part, scan, JointSettings(), {})
    top = [k for k, face in enumerate(part.faces) if face.surface.control_points[..., 2].min() > THICKNESS + 4]
    side = [k for k, face in enumerate(part.faces) if face.surface.control_points[..., 2].max() < 1e-9]
    steps = np.full(len(part.faces), 0.1)
    state = replace(start(problem), last_step=20.0, face_steps=steps.copy())
    state.face_steps[top] = 20.0
    assert torn_faces(problem, state) == tuple(top)
    state.face_steps[side] = 15.0
    assert torn_faces(problem, state) == ()
    assert torn_faces(problem, replace(state, last_step=0.1)) == ()
    held = gauss_newton_step(problem.without_points_on(side), JointSettings().schedule[-2], start(problem))
    assert held.values.count.sum() > 1000
    assert not held.values.count[np.isin(problem.face_of_cell, side)].any()
