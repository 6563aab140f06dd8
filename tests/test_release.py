# SPDX-License-Identifier: LGPL-2.1-or-later
"""The release: package.xml by the rules of FreeCAD's addon index, and a zip that an empty FreeCAD installs and runs."""
from __future__ import annotations

import datetime
import os
import shutil
import stat
import subprocess
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import pytest

import ffds_workbench

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = {"numpy", "scipy", "matplotlib"}
"""On the Addon Manager's list of what it may install (ALLOWED_PYTHON_PACKAGES.txt); all that FFDS cannot do without."""
REPOSITORY = "https://example.org/ffds"


@pytest.fixture(scope="module")
def package():
    return ElementTree.parse(ROOT / "package.xml").getroot()


def _texts(package, name):
    return [element.text for element in package.findall(f"{{*}}{name}")]


def test_package_xml_keeps_the_rules(package):
    for name in ("name", "description", "version", "date", "icon", "freecadmin", "freecadmax", "pythonmin"):
        assert len(_texts(package, name)) == 1 and _texts(package, name)[0].strip(), name
    assert _texts(package, "version") == [ffds_workbench.__version__]
    assert datetime.date.fromisoformat(_texts(package, "date")[0]) <= datetime.date.today()
    assert (ROOT / _texts(package, "icon")[0]).suffix == ".svg" and (ROOT / _texts(package, "icon")[0]).is_file()
    assert 3 <= len(_texts(package, "tag")) == len(set(_texts(package, "tag")))
    assert all(element.get("email") for element in package.findall("{*}maintainer"))
    licence, = package.findall("{*}license")
    assert licence.text == "LGPL-2.1-or-later" and (ROOT / licence.get("file")).is_file()
    assert {element.get("type") for element in package.findall("{*}depend")} == {"python"}
    assert set(_texts(package, "depend")) == PACKAGES
    workbench, = package.iterfind("{*}content/{*}workbench")
    assert workbench.find("{*}subdirectory").text == "./"
    assert f"class {workbench.find('{*}classname').text}" in (ROOT / "InitGui.py").read_text("utf-8")


def test_freecad_reads_it_and_may_run_it():
    import FreeCAD

    metadata = FreeCAD.Metadata(str(ROOT / "package.xml"))
    assert metadata.Name == "FFDS" and metadata.Version == ffds_workbench.__version__
    assert metadata.supportsCurrentFreeCAD()
    assert (metadata.FreeCADMin, metadata.FreeCADMax) == ("0.20.2", "1.1.99")


@pytest.fixture(scope="module")
def checkout(tmp_path_factory):
    """A clone whose last commit is of package.xml's date, as at a release."""
    if shutil.which("git") is None or not (ROOT / ".git").exists():
        pytest.skip("not a checkout of git: no release can be made of it")
    folder = tmp_path_factory.mktemp("release") / "ffds"
    subprocess.run(["git", "clone", "-q", "--depth", "1", ROOT.as_uri(), str(folder)], check=True)
    for name in ("package.xml", "CHANGELOG.md", "resources/scripts/release.sh"):
        shutil.copy(ROOT / name, folder / name)
    _commit(folder)
    return folder


def _commit(folder):
    """Commit all there is, at noon of the date of this checkout's package.xml."""
    date = _texts(ElementTree.parse(ROOT / "package.xml").getroot(), "date")[0] + "T12:00:00"
    name = {f"GIT_{who}_{what}": "x@x" for who in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")}
    subprocess.run(["git", "add", "-A"], cwd=folder, check=True)
    subprocess.run(["git", "commit", "-q", "--allow-empty", "-m", "release"], cwd=folder, check=True,
                   env={**os.environ, **name, "GIT_AUTHOR_DATE": date, "GIT_COMMITTER_DATE": date})


def _release(folder, *arguments, systems=""):
    """Release; unless told without the suite on each system, which these tests are a part of."""
    return subprocess.run(["sh", "resources/scripts/release.sh", *map(str, arguments)], cwd=folder, text=True,
                          capture_output=True, env={**os.environ, "FFDS_SYSTEMS": systems})


def test_the_zip_installs_and_runs_the_bracket(checkout, tmp_path):
    """As the Addon Manager does it: unpacked, without the files' permissions, into Mod/FFDS of an empty FreeCAD."""
    done = _release(checkout, tmp_path, REPOSITORY)
    assert done.returncode == 0, done.stderr
    archive = Path(done.stdout.strip())
    home = tmp_path / "home"
    home.mkdir()
    run = {"env": {**{key: value for key, value in os.environ.items() if key != "PYTHONPATH"},
                   "FREECAD_USER_HOME": str(home)},
           "cwd": tmp_path, "capture_output": True, "text": True, "timeout": 300}
    code = "import FreeCAD; open('said', 'w').write(FreeCAD.getUserAppDataDir())"  # 1.0 prints nothing into pipes
    subprocess.run(["freecadcmd", "-c", code], check=True, **run)
    mod = Path((tmp_path / "said").read_text()) / "Mod" / "FFDS"
    with zipfile.ZipFile(archive) as content:
        assert not [entry for entry in content.infolist() if stat.S_ISLNK(entry.external_attr >> 16)]
        content.extractall(mod)
    described = ElementTree.parse(mod / "package.xml").getroot()
    urls = {element.get("type"): element for element in described.findall("{*}url")}
    assert set(urls) == {"repository", "bugtracker", "readme"}
    assert urls["repository"].text == REPOSITORY and urls["repository"].get("branch") == "main"
    code = ("import sys, ffds_workbench; from ffds_workbench import api, RESOURCES; folder = RESOURCES / 'examples'; "
            "result = api.register(folder / 'bracket.step', folder / 'bracket_scan.ply', faces=['Face6']); "
            "open('said', 'w').write(ffds_workbench.__file__); sys.exit(0 if result.shape.isValid() else 7)")
    done = subprocess.run(["freecadcmd", "-c", code], **run)
    assert done.returncode == 0, done.stdout + done.stderr
    assert mod.resolve() in Path((tmp_path / "said").read_text()).resolve().parents


@pytest.mark.parametrize("file, old, new, words", [
    ("package.xml", "<date>2", "<date>1", "date is 1"), ("package.xml", "<version>", "<version>9", "is not of version"),
    ("CHANGELOG.md", "## ", "## 9", "does not begin with")])
def test_a_release_that_contradicts_itself_is_refused(checkout, tmp_path, file, old, new, words):
    folder = tmp_path / "ffds"
    shutil.copytree(checkout, folder)
    path = folder / file
    path.write_text(path.read_text("utf-8").replace(old, new, 1), "utf-8")
    _commit(folder)
    done = _release(folder, tmp_path)
    assert done.returncode == 3 and words in done.stderr
    assert not list(tmp_path.glob("*.zip"))


def test_no_zip_is_built_where_the_suite_fails(checkout, tmp_path):
    folder = tmp_path / "ffds"
    shutil.copytree(checkout, folder)
    (folder / "tests" / "systems.sh").write_text('echo "asked for $1"; [ "$1" = trixie ]\n')
    _commit(folder)
    done = _release(folder, tmp_path, systems="trixie forky")
    assert done.returncode == 3 and "fails on forky" in done.stderr and "asked for trixie" in done.stdout
    assert not list(tmp_path.glob("*.zip"))


def test_what_is_not_committed_is_not_released(checkout, tmp_path):
    folder = tmp_path / "ffds"
    shutil.copytree(checkout, folder)
    (folder / "new.py").write_text("")
    done = _release(folder, tmp_path)
    assert done.returncode == 3 and "not committed" in done.stderr
