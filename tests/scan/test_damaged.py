# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whatever a scan file holds, it is read into finite points or refused in one sentence; sound ones are read exactly."""
from __future__ import annotations

import resource
from pathlib import Path

import numpy as np
import pytest

from ffds_workbench.benchmark.fuzz import mutations, seeds
from ffds_workbench.errors import InputError
from ffds_workbench.scan import files
from ffds_workbench.scan.formats import lzf

ROOT = Path(__file__).resolve().parents[2]
hypothesis = pytest.importorskip("hypothesis")
from hypothesis import strategies

SEEDS = seeds.scans()
ALL = [content for contents in SEEDS.values() for content in contents]
numbers = strategies.floats(allow_nan=False, allow_infinity=False, width=32, min_value=-2.0**39, max_value=2.0**39)
"""What both single precision and the reader's own bound on coordinates, 1e12, let through."""
clouds = strategies.lists(strategies.tuples(*[numbers] * 3), min_size=3, max_size=40, unique=True).map(np.array)


def many(examples: int):
    """Always the same examples, however long they take on a busy machine."""
    return hypothesis.settings(derandomize=True, deadline=None, database=None, max_examples=examples,
                               suppress_health_check=list(hypothesis.HealthCheck))


def outcome(folder: Path, suffix: str, content: bytes) -> str:
    """What reading says, checked: a cloud of finite points, or one sentence that names the file."""
    path = folder / f"scan{suffix}"
    path.write_bytes(content)
    try:
        cloud = files.read(path)
    except InputError as error:
        assert str(path) in str(error) and "\n" not in str(error) and len(str(error)) < 300 + len(str(path))
        return str(error)
    assert len(cloud.points) > 1 and np.isfinite(cloud.points).all()
    assert cloud.normals is None or np.isfinite(cloud.normals).all()
    return ""


@pytest.mark.parametrize("suffix", SEEDS)
def test_the_seeds_are_sound(tmp_path, suffix):
    for content in SEEDS[suffix]:
        assert outcome(tmp_path, suffix, content) == ""


@pytest.mark.parametrize("suffix", SEEDS)
def test_damage_of_every_kind(tmp_path, suffix):
    @many(100)
    @hypothesis.given(strategies.integers(0, len(SEEDS[suffix]) - 1), strategies.integers(0, 2**32 - 1))
    def check(seed, state):
        outcome(tmp_path, suffix, mutations.mutated(SEEDS[suffix][seed], ALL, np.random.default_rng(state)))

    check()


@pytest.mark.parametrize("suffix", files.FORMATS)
def test_any_bytes(tmp_path, suffix):
    @many(50)
    @hypothesis.given(strategies.binary(max_size=300) | strategies.text(max_size=100).map(str.encode))
    def check(content):
        outcome(tmp_path, suffix, content)

    check()


@pytest.mark.parametrize("name", ["ply ascii", "ply binary_little_endian", "ply binary_big_endian", "pcd binary",
                                  "pcd binary_compressed", "xyz"])
def test_points_are_read_as_they_were_written(tmp_path, name):
    kind, _, encoding = name.partition(" ")

    @many(40)
    @hypothesis.given(clouds)
    def check(points):
        if kind == "xyz":
            content = "\n".join(" ".join(map(repr, row)) for row in points.tolist()).encode()
        elif kind == "ply":
            content = seeds.ply(points, encoding)
        else:
            content = seeds.pcd(np.hstack([points, np.zeros_like(points)]), encoding)
        path = tmp_path / f"scan.{kind}"
        path.write_bytes(content)
        # The ascii seeds have six decimals.
        np.testing.assert_allclose(files.read(path).points, points, rtol=0, atol=6e-7 if encoding == "ascii" else 0)

    check()


@many(200)
@hypothesis.given(strategies.lists(strategies.binary(max_size=40) | strategies.integers(1, 400).map(bytes)))
def test_lzf_gives_back_what_was_packed(pieces):
    data = b"".join(pieces)
    packed = seeds.lzf(data)
    assert lzf.decompress(packed, len(data)) == data
    for wrong in (len(data) + 1, max(len(data) - 1, 0) + (not data)):
        with pytest.raises(ValueError):
            lzf.decompress(packed, wrong)


def test_lzf_is_what_open3d_writes(tmp_path):
    open3d = pytest.importorskip("open3d")
    points = np.repeat(np.random.default_rng(3).integers(0, 50, (4000, 3)), 2, axis=0) / 8
    cloud = open3d.t.geometry.PointCloud(open3d.core.Tensor(points))
    open3d.t.io.write_point_cloud(str(tmp_path / "s.pcd"), cloud, compressed=True)
    np.testing.assert_array_equal(files.read(tmp_path / "s.pcd").points, points)


HUGE = {
    "promise.ply": (b"ply\nformat binary_little_endian 1.0\nelement vertex 999999999999999999\nproperty float x\n"
                    b"property float y\nproperty float z"
                     b"\nend_header\n" + bytes(24), "999999999999999999 points, 2 are"),
    "promise text.ply": (b"ply\nformat ascii 1.0\nelement vertex 999999999999\nproperty float x\nproperty float y\n"
                         b"property float z\nend_header\n0 0 0\n1 1 1\n", "promises 999999999999 points, 2 are there"),
    "negative.ply": (b"ply\nformat binary_little_endian 1.0\nelement vertex -1\nproperty float x\nproperty float y\n"
                     b"property float z\nend_header\n" + bytes(24), "element vertex -1"),
    "before.ply": (b"ply\nformat binary_little_endian 1.0\nelement camera 999999999999999999\nproperty double a\n"
                   b"element vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n" + bytes(24),
                   "0 are there"),
    "wide.pcd": (b"VERSION 0.7\nFIELDS x y z _\nSIZE 4 4 4 1\nTYPE F F F U\nCOUNT 1 1 1 999999999999\nPOINTS 2\n"
                 b"DATA binary\n" + bytes(24), "0 are there"),
    "bomb.pcd": (b"VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 357913941\nDATA binary_compressed\n"
                 + (6).to_bytes(4, "little") + (4294967292).to_bytes(4, "little") + b"\0\0\xe0\xff\0\0", "unpacked"),
    "type.pcd": (b"VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F (\nPOINTS 2\nDATA binary\n" + bytes(24),
                 "header is not complete"),
    "count.pcd": (b"VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 0 1 1\nPOINTS 2\nDATA ascii\n" + bytes(24),
                  "makes no sense"),
    "short.stl": (bytes(34), "not an STL"),
    "promise.pts": (b"99999999999999999999\n1 2 3\n4 5 6\n", "line 1 has fewer than 3"),
    "far.xyz": (b"1e300 0 0\n0 1e13 0\n", "2 rows are not finite"),
    "digits.xyz": (b"9" * 100000 + b"x\n" + b"1 2 3\n" * 3, "line 1 has fewer than 3"),
}


@pytest.mark.parametrize("name", HUGE)
def test_absurd_promises_take_no_memory(tmp_path, name):
    content, message = HUGE[name]
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    assert message in outcome(tmp_path, Path(name).suffix, content)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 50_000  # kB; the files hold 100 kB at most


FIELDS = ('<cartesianX type="Float"/><cartesianY type="Float"/><cartesianZ type="ScaledInteger" minimum="-1048576" '
          'maximum="1048575" scale="0.001"/>')
E57 = {
    "too many": ('recordCount="50"', 'recordCount="51"'),
    "none of them takes room": (FIELDS, FIELDS.replace('"Float"', '"Integer" minimum="1" maximum="1"')
                                .replace('"ScaledInteger" minimum="-1048576" maximum="1048575" scale="0.001"',
                                         '"Integer" minimum="1" maximum="1"')),
    "a range that ends before it begins": ('maximum="1048575"', 'maximum="-1048577"'),
    "a range beyond numbers": ('minimum="-1048576"', f'minimum="-{"9" * 400}"'),
    "an offset before the file": ('fileOffset="48"', 'fileOffset="-48"'),
    "entities": ('<?xml version="1.0" encoding="UTF-8"?>', "<!DOCTYPE a [<!ENTITY b 'c'>]>"),
    "an encoding of its own": ("UTF-8", "UTFm8"),
}


@pytest.mark.parametrize("name", E57)
def test_e57_that_makes_no_sense(tmp_path, name):
    points = np.random.default_rng(5).uniform(0, 100, (50, 3))
    assert outcome(tmp_path, ".e57", seeds.e57(points)) == ""
    content = seeds.e57(points, *E57[name])
    assert content != seeds.e57(points)
    assert "damaged or cut off: its E57 sections" in outcome(tmp_path, ".e57", content)


def test_the_damaged_scans_beside_the_project(shared_data):
    bad = [path for path in sorted((shared_data / "bad").iterdir()) if path.suffix in files.FORMATS]
    assert len(bad) >= 8
    for path in bad:
        try:
            assert len(files.read(path).points) > 1
        except InputError as error:
            assert "\n" not in str(error) and str(path) in str(error)
