# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which files a series takes: folders, patterns, lists, and what comes into a watched folder."""
from __future__ import annotations

import os

import pytest

from ffds_workbench.errors import InputError
from ffds_workbench.series.folder import INDEX
from ffds_workbench.series.index import PartIndex
from ffds_workbench.series.scans import ScanFile, find_scans
from ffds_workbench.series.setup import Outcome
from ffds_workbench.series.watch import STOP, Watch


@pytest.fixture
def files(tmp_path):
    for name in ("part10.ply", "part2.ply", "part1.xyz", "notes.md", ".hidden.ply"):
        (tmp_path / name).write_text("1 2 3\n4 5 6\n")
    return tmp_path


def names(scans):
    return [scan.path.name for scan in scans]


def test_folders_and_patterns_in_the_order_of_their_numbers(files):
    assert names(find_scans([files])) == ["part1.xyz", "part2.ply", "part10.ply"]
    assert names(find_scans([files / "*.ply", files])) == ["part2.ply", "part10.ply", "part1.xyz"]


def test_lists_with_labels(files):
    (files / "lot.csv").write_text("scan,cavity,time\npart2.ply,left,2026-12-01\npart1.xyz,,2026-12-02\n")
    found = find_scans([files / "lot.csv"])
    assert names(found) == ["part2.ply", "part1.xyz"]
    assert [dict(scan.labels) for scan in found] == [{"cavity": "left", "time": "2026-12-01"}, {"time": "2026-12-02"}]
    (files / "lot.txt").write_text("# the morning's\npart10.ply\n")
    assert names(find_scans([files / "lot.txt"])) == ["part10.ply"]
    assert names(find_scans([files / "part1.xyz"])) == ["part1.xyz"]  # a text file of points is a scan


@pytest.mark.parametrize(("content", "said"), [("scan\nmissing.ply\n", "names missing.ply, which does not exist"),
                                               ("", "holds no scan")])
def test_lists_that_are_none(files, content, said):
    (files / "lot.lst").write_text(content)
    with pytest.raises(InputError, match=said):
        find_scans([files / "lot.lst"])


def test_what_is_not_there(files):
    with pytest.raises(InputError, match="does not exist"):
        find_scans([files / "part3.ply"])
    (files / "empty").mkdir()
    with pytest.raises(InputError, match="holds no scan"):
        find_scans([files / "empty"])


def test_a_watched_file_is_taken_when_it_is_whole(tmp_path):
    watch, path = Watch(tmp_path), tmp_path / "part1.ply"
    path.write_text("half")
    assert watch.new() == []
    path.write_text("half and more")
    assert watch.new() == []  # it has grown since the last look
    assert names(watch.new()) == ["part1.ply"] and watch.new() == []
    assert not watch.ended
    (tmp_path / STOP).touch()
    assert watch.ended
    with pytest.raises(InputError, match="does not exist"):
        Watch(tmp_path / "nowhere")


def test_names_of_folders_stay(tmp_path):
    """Two scans of one name get folders of their own, and keep them when the series goes on."""
    index = PartIndex(tmp_path / INDEX)
    first = index.add([ScanFile(tmp_path / "a" / "scan.ply"), ScanFile(tmp_path / "b" / "scan.ply"),
                       ScanFile(tmp_path / "index.html.ply")])
    assert [job.name for job in first] == ["scan", "scan_2", "index.html_2"]
    index.record(Outcome(first[0].scan, "scan", 0))
    index.close()
    again = PartIndex(tmp_path / INDEX)
    assert [job.name for job in again.add([ScanFile(tmp_path / "b" / "scan.ply"),
                                           ScanFile(tmp_path / "a" / "scan.ply")])] == ["scan_2"]
    again.close()


def test_an_index_that_is_none(tmp_path):
    (tmp_path / INDEX).write_bytes(os.urandom(4096))
    with pytest.raises(InputError, match="no index of a series"):
        PartIndex(tmp_path / INDEX)
