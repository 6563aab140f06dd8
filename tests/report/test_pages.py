# SPDX-License-Identifier: LGPL-2.1-or-later
"""The report for people of the example: one page and a PDF, opened, turned and read in a browser without a network."""
from __future__ import annotations

import io
import re
import shutil
import subprocess

import numpy as np
import pytest
from matplotlib.image import imread

from ffds_workbench import RESOURCES, api
from ffds_workbench.api import certified
from ffds_workbench.errors import InputError
from ffds_workbench.report.maps.lone_points import lone_points
from ffds_workbench.report.pages.html_file import THREE
from ffds_workbench.report.pages.pictures import picture
from ffds_workbench.report.pages.scene import ColouredPart

LARGEST = 5_000_000
"""Bytes of the example's page."""
_HAND = """<script>
window.onload = function () {
  var canvas = document.querySelector('#view canvas'), box = canvas.getBoundingClientRect(), read = [];
  for (var k = 1; k < 20; k++) {
    canvas.dispatchEvent(new MouseEvent('mousemove', {clientX: box.left + k * box.width / 20,
                                                      clientY: box.top + box.height / 2}));
    read.push(document.getElementById('value').textContent);
  }
  document.body.setAttribute('data-read', read.join('|'));
  canvas.dispatchEvent(new MouseEvent('mousedown', {clientX: 300, clientY: 300, button: 0, bubbles: true}));
  document.dispatchEvent(new MouseEvent('mousemove', {clientX: 380, clientY: 300}));
  document.dispatchEvent(new MouseEvent('mouseup', {}));
};
</script>"""
"""A mouse that goes over the part and turns it."""


def test_points_in_the_air_stand_alone_and_those_of_a_surface_do_not():
    random = np.random.default_rng(0)
    sheet = np.column_stack([random.uniform((0, 0), (80, 60), (8000, 2)), random.normal(0, 0.05, 8000)])
    air = random.uniform((0, 0, 5), (80, 60, 40), (60, 3))
    lone = lone_points(np.concatenate([sheet, air]))
    assert lone[8000:].all()
    assert lone[:8000].sum() == 0  # corners have a quarter of the neighbours, at twice the distance
    assert not lone_points(air[:10]).any()


def test_a_picture_of_many_triangles_has_no_holes():
    """A square of 125,000 triangles seen from above, as many as a part of 250 faces has."""
    count = 250
    points = np.stack([*np.indices((count + 1, count + 1)).reshape(2, -1), np.zeros((count + 1) ** 2)], axis=1)
    corner = (np.arange(count)[:, None] * (count + 1) + np.arange(count)).ravel()
    triangles = corner[:, None] + np.concatenate([[[0, count + 1, 1]], [[1, count + 1, count + 2]]])[:, None]
    flat, face_of = np.zeros(len(points)), np.zeros(2 * count**2, dtype=np.intp)
    scene = ColouredPart(points, triangles.reshape(-1, 3), flat, flat, face_of, ("Face1",), [])
    image = imread(io.BytesIO(picture(scene, np.array([0.0, 0.0, 1.0]))))
    height, width = image.shape[:2]
    inner = image[height // 2 - 50 : height // 2 + 50, width // 5 : width // 5 + 50, :3]
    assert inner[:, :, 0].max() < 0.7  # red of paper is 1, and of the scale's middle 0.55


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """The page and the PDF of the example's upright face."""
    folder, example = tmp_path_factory.mktemp("pages"), RESOURCES / "examples"
    with pytest.MonkeyPatch.context() as patch:  # others look at the check for Boolean operations
        patch.setattr(certified, "BOOLEAN_CHECK_SECONDS", 0.05)
        _write(folder, example)
    return folder / "report.html"


def _write(folder, example) -> None:
    result = api.register(api.read_model(example / "bracket.step"), api.read_scan(example / "bracket_scan.ply"),
                          faces=["Face9"])
    api.write_pages(result, folder / "report.html", folder / "report.pdf", sides=[(1, -1, 1)])
    with pytest.raises(InputError, match="is no direction"):
        api.write_pages(result, folder / "none.html", sides=[(0, 0, 0)])
    assert not (folder / "none.html").exists()


def test_the_page_needs_nothing_beside_it_and_says_everything(page):
    text = page.read_text("utf-8")
    assert len(text.encode()) < LARGEST
    own = re.sub(r"<script>.*?</script>", "", text, flags=re.DOTALL)
    assert not re.search(r"(src|href)=\"(?!data:)", own)
    for said in ("fits the scan within its noise", "Face9", "order kept", "largest edge gap", "numpy", "whole part"):
        assert (said in own) == (said != "whole part"), said
    assert own.count("data:image/png") == 1


def test_the_pdf_has_its_pages(page):
    raw = page.with_suffix(".pdf").read_bytes()
    assert raw.startswith(b"%PDF") and len(re.findall(rb"/Type /Page\b", raw)) == 3


@pytest.mark.skipif(shutil.which("chromium") is None or not THREE.is_dir(), reason="chromium or libjs-three is missing")
def test_the_part_turns_and_tells_its_deviation_in_a_browser(page, tmp_path):
    probe = tmp_path / "probe.html"
    probe.write_text(page.read_text("utf-8").replace("</body>", _HAND + "</body>"), "utf-8")
    done = subprocess.run(
        ["chromium", "--headless", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
         f"--user-data-dir={tmp_path / 'chromium'}", "--host-resolver-rules=MAP * ~NOTFOUND",
         "--virtual-time-budget=3000", "--dump-dom", probe.as_uri()], capture_output=True, text=True, timeout=60)
    found = dict(re.findall(r"data-(drawn|read|camera)=\"([^\"]*)\"", done.stdout))
    assert int(found["drawn"]) > 1000, done.stderr
    assert re.search(r"Face9: [+−]0\.\d{3} mm", found["read"]) and "no scan there" in found["read"]
    assert found["camera"]  # it was turned
