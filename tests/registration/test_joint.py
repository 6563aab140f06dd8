# SPDX-License-Identifier: LGPL-2.1-or-later
"""The joint solve on a thin plate, bent exactly without stretching, against the analytic shape."""
import numpy as np
import pytest

FreeCAD = pytest.importorskip("FreeCAD")
import Part

from ffds_workbench.brep.joint_part import joint_part
from ffds_workbench.brep.workpiece import read
from ffds_workbench.errors import RefusedError
from ffds_workbench.registration.joint import JointSettings, SensorProfile, register_joint
from ffds_workbench.registration.joint.problem import make_problem

LENGTH, WIDTH, THICKNESS, RADIUS = 60.0, 40.0, 2.0, 300.0
NOISE, DENSITY = 0.05, 10.0


@pytest.fixture(scope="module")
def part():
    return joint_part(read(Part.makeBox(LENGTH, WIDTH, THICKNESS)))


def bent(points):
    """The plate rolled about an axis along y: the mid surface keeps its lengths, normals stay straight."""
    angle = (points[:, 0] - LENGTH / 2) / RADIUS
    height = points[:, 2] - THICKNESS / 2
    return np.column_stack([LENGTH / 2 + (RADIUS - height) * np.sin(angle), points[:, 1],
                            THICKNESS / 2 + RADIUS - (RADIUS - height) * np.cos(angle)])


def deviation(points):
    """Distance of points from the bent mid surface, signed towards the centre of the roll."""
    return RADIUS - np.hypot(points[:, 0] - LENGTH / 2, points[:, 2] - THICKNESS / 2 - RADIUS)


def scan_of(heights, seed=0, noise=NOISE):
    """Noisy points on the skins at the given heights of the plate."""
    random = np.random.default_rng(seed)
    count = int(LENGTH * WIDTH * DENSITY)
    skins = [np.column_stack([random.uniform(0, LENGTH, count), random.uniform(0, WIDTH, count), np.full(count, z)])
             for z in heights]
    points = bent(np.concatenate(skins))
    return points + np.array([0.0, 0.0, 1.0]) * random.normal(0, noise, (len(points), 1))


def skin(part, height):
    """Index of the face at a height of the plate."""
    for index, face in enumerate(part.faces):
        z = face.surface.control_points[..., 2]
        if np.ptp(z) < 1e-9 and abs(z.mean() - height) < 1e-9:
            return index
    raise AssertionError


def as_built(part, result, face):
    uv = result.faces[face].uv
    return part.faces[face].surface(uv) + result.faces[face].displacement(uv)


def test_one_view_of_a_bent_sheet(part):
    result = register_joint(part, scan_of([THICKNESS]))
    top, bottom = skin(part, THICKNESS), skin(part, 0.0)
    # σ √(dof / n): some 60 degrees of freedom and 24 000 points leave 0.0025 mm; twice that for the mean.
    assert np.abs(deviation(as_built(part, result, top)) - THICKNESS / 2).mean() < 0.005
    # Hidden skin: carried by the sheet's thickness, known to 0.02 mm by assumption, exact here.
    assert np.abs(deviation(as_built(part, result, bottom)) + THICKNESS / 2).mean() < 0.01
    assert result.thickness[0] == pytest.approx(THICKNESS, abs=0.01)
    assert result.isometric
    assert result.faces[top].flag == "observed" and result.faces[bottom].flag == "carried"
    assert result.faces[bottom].band > result.faces[top].band


def test_hiding_a_face_widens_its_band(part):
    bottom = skin(part, 0.0)
    seen = register_joint(part, scan_of([0.0, THICKNESS])).faces[bottom]
    hidden = register_joint(part, scan_of([THICKNESS])).faces[bottom]
    assert (seen.flag, hidden.flag) == ("observed", "carried")
    assert hidden.band > 2 * seen.band
    assert hidden.points == 0 and hidden.coverage == 0.0


def test_rigid_motion_of_a_solid(part):
    shift = np.array([0.0, 0.0, 0.8])
    random = np.random.default_rng(1)
    flat = np.column_stack([random.uniform(0, [LENGTH, WIDTH], (24000, 2)), THICKNESS + random.normal(0, NOISE, 24000)])
    result = register_joint(part, flat + shift)
    # Seen along z only: the prior must keep the plate from sliding, noise over 24 000 points moves it by 1e-3 mm.
    assert result.solids[0].T_asbuilt_nominal[:3, 3] == pytest.approx(shift, abs=0.03)
    assert result.solids[0].deformation < 0.01


def test_band_covers_the_truth_on_white_noise(part):
    covered = []
    for seed in range(3):
        result = register_joint(part, scan_of([0.0, THICKNESS], seed))
        for height in (0.0, THICKNESS):
            face = skin(part, height)
            error = deviation(as_built(part, result, face)) - (height - THICKNESS / 2)
            covered.append(np.abs(error) < result.faces[face].bands)
    # 3 × 2 faces of some ten independent places each: 0.95 ± 0.06 at two standard deviations.
    assert np.mean(np.concatenate(covered)) > 0.89


def test_sensor_profile_widens_the_bands(part):
    top = skin(part, THICKNESS)
    plain = register_joint(part, scan_of([THICKNESS])).faces[top].band
    settings = JointSettings(sensor=SensorProfile(NOISE, NOISE, 2.0))
    inflation = 1 + settings.sensor.shared * DENSITY / NOISE**2      # of the variance of a mean over a large area
    correlated = register_joint(part, scan_of([THICKNESS]), settings).faces[top].band
    # Stiffer against weaker data: the band grows by less than the noise does, but clearly.
    assert 0.3 * np.sqrt(inflation) < correlated / plain < 1.2 * np.sqrt(inflation)


def test_frozen_faces_stay(part):
    bottom = skin(part, 0.0)
    frozen = type(part)(part.faces, part.edges, part.solids, frozenset([bottom]))
    result = register_joint(frozen, scan_of([THICKNESS]))
    assert np.abs(result.faces[bottom].displacement.control_points).max() < 1e-3


@pytest.mark.parametrize("points, why", [
    (np.zeros((3, 3)), "points"),
    (scan_of([THICKNESS]) + [0, 0, 1e4], "overlap"),
    (scan_of([THICKNESS]) / 1000, "extends over only"),
])
def test_refusals(part, points, why):
    with pytest.raises(RefusedError, match=why):
        register_joint(part, points)


def test_everything_frozen(part):
    with pytest.raises(RefusedError, match="frozen"):
        register_joint(type(part)(part.faces, part.edges, part.solids, frozenset(range(6))), scan_of([THICKNESS]))


def test_less_noise_is_never_worse(part):
    """Down to none at all, as in the first cloud that anybody makes."""
    top, bottom = skin(part, THICKNESS), skin(part, 0.0)
    errors = []
    for noise in (NOISE, NOISE / 10, NOISE / 100, 0.0):
        result = register_joint(part, scan_of([THICKNESS], noise=noise))
        errors.append([np.abs(deviation(as_built(part, result, face)) - height).mean()
                       for face, height in ((top, THICKNESS / 2), (bottom, -THICKNESS / 2))])
    errors = np.array(errors)
    # A tenth for chance, and a micrometre: the lattice, the rounding of the surfaces, one Gauss-Newton step.
    assert (errors[1:] < 1.1 * errors[:-1] + 1e-3).all(), errors
    assert errors[-1].max() < 2e-3, errors


@pytest.mark.parametrize("count", [100, 400, 4000])
def test_noise_of_few_points_is_not_their_distance_across_the_part(part, count):
    """A dozen neighbours lie on both skins of the plate, or around its bend."""
    random = np.random.default_rng(count)
    points = scan_of([0.0, THICKNESS], count)
    points = points[random.permutation(len(points))[:count]]
    problem = make_problem(part, points, JointSettings(), {})
    found = problem.lengths.noise
    assert problem.statistics.noise == found  # that tells the skins as well
    # The median absolute deviation of n/2 differences is known to 1.17 / √(n/2), 0.17 for 100 points; twice that. A
    # plate 1.5 mm off slopes by 0.1 at its ends: neighbours 3.5 mm apart differ by up to 0.35 mm; a sixth as a rule.
    assert 0.6 * NOISE < found < 1.4 * NOISE + 0.06 / np.sqrt(count / 100)


def test_few_points_are_used(part):
    """600 points, two per square millimetre of noise squared: the plate as a whole is known to a fraction of it."""
    top = skin(part, THICKNESS)
    points = scan_of([THICKNESS], 3)[:600]
    error = np.abs(deviation(as_built(part, register_joint(part, points), top)) - THICKNESS / 2)
    # Least squares of the roll with its two or three shapes: σ √(3/600) = 0.004 mm, and some 30 of the lattice: 0.011.
    assert error.mean() < 0.02
