"""The wheel holds all that a user needs, and runs where there is no source folder."""

import os
import subprocess
import sys
import sysconfig
import venv
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]

pytestmark = pytest.mark.slow


def call(*command, **more):
    ran = subprocess.run([*map(str, command)], capture_output=True, text=True, check=False, timeout=600, **more)
    assert ran.returncode == 0, f"{command}\n{ran.stdout}\n{ran.stderr}"
    assert "Traceback" not in ran.stderr
    return ran


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    folder = tmp_path_factory.mktemp("wheel")
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "wheel"]
    call(*pip, "--quiet", "--no-deps", "--no-build-isolation", "--wheel-dir", folder, ROOT)
    (file,) = folder.glob("tractionpower-*.whl")
    return file


@pytest.fixture(scope="module")
def command(wheel, tmp_path_factory):
    """Return the command of a fresh environment with the wheel; what it depends on is borrowed from this one."""
    folder = tmp_path_factory.mktemp("environment")
    venv.create(folder, with_pip=False)
    scripts = folder / ("Scripts" if os.name == "nt" else "bin")
    python = scripts / Path(sys.executable).name
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "--python", python, "install"]
    call(*pip, "--quiet", "--no-deps", "--no-index", wheel)
    code = "import sysconfig; print(sysconfig.get_paths()['purelib'])"
    purelib = Path(call(python, "-c", code).stdout.strip())
    (purelib / "borrowed.pth").write_text(sysconfig.get_paths()["purelib"] + "\n", encoding="utf-8")
    where = call(python, "-c", "import tractionpower; print(tractionpower.__file__)", cwd=folder).stdout.strip()
    assert Path(where).is_relative_to(purelib)
    return scripts / "tractionpower"


def test_data_travel_in_the_wheel(wheel):
    names = zipfile.ZipFile(wheel).namelist()
    for kind, file in (("lines", "study.yaml"), ("validation", "case.yaml")):
        folders = {path.parent.name for path in (ROOT / kind).glob(f"*/{file}")}
        assert folders
        assert {f"tractionpower/_data/{kind}/{folder}/{file}" for folder in folders} <= set(names)
    stock = [path for path in (ROOT / "rollingstock").rglob("*.*") if path.suffix in {".yaml", ".csv", ".ini", ".md"}]
    assert {path.parent.parent.name for path in stock} >= {"rollingstock", "dynamics"}
    for path in stock:
        assert f"tractionpower/_data/{path.relative_to(ROOT).as_posix()}" in names
    tables = ("limits", "conductors", "duty_classes", "rectifier_units")
    assert {f"tractionpower/data/{table}.csv" for table in tables} <= set(names)
    page = {path.name for path in (ROOT / "src" / "tractionpower" / "web" / "static").iterdir()}
    assert {"index.html", "uplot.js", "uplot-LICENSE.txt"} <= page
    assert {f"tractionpower/web/static/{name}" for name in page} <= set(names)
    assert any(name.endswith("licenses/LICENSE") for name in names)


def test_nothing_else_travels_in_the_wheel(wheel):
    names = zipfile.ZipFile(wheel).namelist()
    assert {name.split("/")[0].split("-")[0] for name in names} == {"tractionpower"}
    strange = ("osrd", "__pycache__", "/tests/", "/reports/", "/benchmarks/", "//")
    assert [name for name in names if any(word in f"/{name.lower()}" for word in strange)] == []


def test_no_file_of_the_wheel_names_this_machine(wheel):
    archive = zipfile.ZipFile(wheel)
    named = [name for name in archive.namelist() if b"/work/" in archive.read(name) or str(ROOT).encode() in archive.read(name)]
    assert named == []


def test_a_shipped_line_runs_and_the_cases_are_met_in_an_empty_folder(command, tmp_path):
    environment = {key: value for key, value in os.environ.items() if not key.startswith("PYTHON")}
    environment["TRACTIONPOWER_CACHE_DIR"] = str(tmp_path / "cache")
    folder = tmp_path / "empty"
    folder.mkdir()
    ran = call(command, "run", "two-substations", cwd=folder, env=environment)
    assert "the lines that ship with tractionpower" in ran.stderr
    assert "compiling the kernels" in ran.stderr
    assert (folder / "reports" / "two-substations" / "run.json").is_file()
    ran = call(command, "journey", "two-substations", "--train", "2", cwd=folder, env=environment)
    assert "00:09:04" in ran.stdout
    call(command, "curves", "en57", cwd=folder, env=environment)
    assert (folder / "reports" / "curves" / "en57.png").is_file()
    ran = call(command, "validate", cwd=folder, env=environment)
    assert ", 0 missed" in ran.stdout
    assert [path.name for path in folder.iterdir()] == ["reports"]
