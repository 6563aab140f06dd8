# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sensor profiles are measured back from scans whose noise the virtual sensor made, and read back as written.

A field of length l over an area A has about A / (4π l²) independent patches, from which its variance is known to
√(2 / patches) of itself; tolerances are four times that, on the standard deviation half of it.
"""
from __future__ import annotations

import json

import FreeCAD
import numpy as np
import Part
import pytest

from ffds_workbench.brep import workpiece
from ffds_workbench.cli import sensor as command
from ffds_workbench.errors import InputError, RefusedError
from ffds_workbench.registration.joint import SensorProfile
from ffds_workbench.scan import sensor_profile
from ffds_workbench.scan.sensor import Scene, SensorSettings, View, simulate
from ffds_workbench.scan.sensor_noise import measure

WIDE, HIGH = 80.0, 60.0
UP = View((0.0, 0.0, 1.0))


def scan_of(shape: Part.Shape, seed: int, **settings) -> np.ndarray:
    piece = workpiece.read(shape)
    target = Scene([piece.geometry(i) for i in range(len(piece.faces))])
    return simulate(target, SensorSettings(spacing=0.4, views=(UP,), seed=seed, **settings)).points


def correlated_field(length: float) -> float:
    """Relative standard deviation of the standard deviation of a field over the datum."""
    return 0.5 * np.sqrt(2 * 4 * np.pi * length**2 / (WIDE * HIGH))


@pytest.mark.parametrize(("noise", "share", "width"), [(0.13, 0.3, 1.5), (0.05, 0.5, 0.7)])
def test_flat_datum(noise, share, width):
    profile = measure([scan_of(Part.makePlane(WIDE, HIGH), 1, noise=noise, correlation=width, correlated_share=share)])
    length = np.sqrt(2) * width              # a Gaussian filter of that width leaves the covariance exp(−r²/4 width²)
    spread = 4 * correlated_field(length)
    assert profile.sigma == pytest.approx(noise * np.sqrt(1 - share), rel=0.02)
    assert profile.sigma_c == pytest.approx(noise * np.sqrt(share), rel=spread)
    assert profile.correlation_length == pytest.approx(length, rel=spread)


def test_white_noise_shares_nothing():
    profile = measure([scan_of(Part.makePlane(WIDE, HIGH), 2)])
    # 30 000 points: σ / √(2n) = 0.0005; what is tilted away from the camera is seen at a slant of up to 8°
    assert profile.sigma == pytest.approx(0.13, abs=0.002)
    assert profile.sigma_c == 0


def test_outliers_do_not_count():
    scan = scan_of(Part.makePlane(WIDE, HIGH), 3, outliers=0.02)
    assert measure([scan]).sigma == pytest.approx(0.13, rel=0.02)


def test_repeated_scans_of_a_curved_part():
    shape = Part.makeCylinder(90, WIDE, FreeCAD.Vector(), FreeCAD.Vector(0, 1, 0), 60).Faces[0]
    shape.rotate(FreeCAD.Vector(), FreeCAD.Vector(0, 1, 0), -60)
    scans = [scan_of(shape, seed, correlation=1.5, correlated_share=0.3) for seed in (4, 5, 6)]
    profile = measure(scans)
    # along the normal the noise is that along the view times its cosine, up to 60° away
    assert 0.5 * 0.13 * np.sqrt(0.7) < profile.sigma < 0.13 * np.sqrt(0.7) * 1.02
    assert 0.5 * 0.13 * np.sqrt(0.3) < profile.sigma_c < 0.13 * np.sqrt(0.3) * (1 + 4 * correlated_field(2.1))
    assert 1.5 < profile.correlation_length < 3.5


def test_several_flat_scans_are_averaged():
    scans = [scan_of(Part.makePlane(WIDE, HIGH), seed, correlation=1.5, correlated_share=0.3) for seed in (7, 8)]
    one, two = (measure([scan]) for scan in scans)
    both = measure(scans, flat=True)
    assert min(one.sigma_c, two.sigma_c) <= both.sigma_c <= max(one.sigma_c, two.sigma_c)
    assert both.shared == pytest.approx(0.5 * (one.shared + two.shared))


def test_refusals():
    with pytest.raises(RefusedError, match="1000"):
        measure([np.random.default_rng(0).normal(size=(500, 3))])
    with pytest.raises(RefusedError, match="flat"):
        measure([scan_of(Part.makeSphere(30), 9)])
    plane = scan_of(Part.makePlane(WIDE, HIGH), 10)
    with pytest.raises(RefusedError, match="same thing"):
        measure([plane, plane + [200.0, 0.0, 0.0]])


def test_profiles_are_files_or_presets(tmp_path):
    profile = SensorProfile(0.11, 0.07, 2.1, "mine")
    sensor_profile.write(profile, tmp_path / "p.json")
    assert sensor_profile.find(tmp_path / "p.json") == profile == sensor_profile.find(profile)
    assert sensor_profile.find("paper").sigma == 0.13
    assert tuple(sensor_profile.PRESETS) == command.PRESETS


@pytest.mark.parametrize(("text", "why"), [("{", "JSON"), ("[]", "numbers"), ('{"sigma": 0.1}', "numbers"),
                                           ('{"sigma": 0, "sigma_c": 0, "correlation_length": 0}', "positive")])
def test_bad_profiles(tmp_path, text, why):
    (tmp_path / "p.json").write_text(text)
    with pytest.raises(InputError, match=why):
        sensor_profile.find(tmp_path / "p.json")


def test_missing_profile():
    with pytest.raises(InputError, match="does not exist"):
        sensor_profile.find("nothing.json")


def test_shared_is_the_integral_of_the_covariance():
    step = 1e-3
    radius = np.arange(0.5 * step, 30.0, step)
    covariance = 0.05**2 * np.exp(-(radius**2) / (2 * 2.0**2))
    assert SensorProfile(0.1, 0.05, 2.0).shared == pytest.approx((2 * np.pi * radius * covariance).sum() * step)


def test_written_as_plain_json(tmp_path):
    sensor_profile.write(SensorProfile(0.1), tmp_path / "p.json")
    assert json.loads((tmp_path / "p.json").read_text())["sigma"] == 0.1
