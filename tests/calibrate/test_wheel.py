"""The wheel: built, installed in an empty environment outside the checkout, and used there."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import sysconfig
import venv
import zipfile
from pathlib import Path

import pytest

from tests.paths import ROOT

PARAMETERS = ["mu_pp=0.5", "mu_roll_pp=0.1", "mu_pw=0.3", "mu_roll_pw=0.3", "e_pp=0.7", "e_pw=0.4"]
# A handful of grains for 336 time steps; numba stays off because compiling would take longer.
TINY = ["mass_fraction=0.002", "flight_s=0.01", "pipe_length_m=0.02"]


@pytest.fixture(scope="module")
def wheel(tmp_path_factory) -> Path:
    out = tmp_path_factory.mktemp("wheel")
    subprocess.run(
        [
            sys.executable,
            "-m",
            "build",
            "--wheel",
            "--no-isolation",
            "--outdir",
            str(out),
            str(ROOT),
        ],
        check=True,
        capture_output=True,
        timeout=120,
    )
    (found,) = out.glob("bulkcal-*.whl")
    return found


@pytest.fixture(scope="module")
def installed(wheel: Path, tmp_path_factory) -> Path:
    """Return an environment that holds the wheel and nothing else."""
    home = tmp_path_factory.mktemp("elsewhere") / "env"
    venv.create(home, with_pip=False)
    subprocess.run(
        [sys.executable, "-m", "pip", "--python", str(home / "bin" / "python"), "install",
         "--quiet", "--no-deps", "--no-index", "--disable-pip-version-check", str(wheel)],
        check=True,
        capture_output=True,
        timeout=120,
    )  # fmt: skip
    return home


def call(installed: Path, cwd: Path, *words: str) -> str:
    """Run the installed `bulkcal`; its dependencies come from this environment by path.

    A path entry does not follow .pth files, so an editable install of the checkout stays unseen.
    """
    environment = {
        **os.environ,
        "PYTHONPATH": sysconfig.get_path("purelib"),
        "NUMBA_DISABLE_JIT": "1",
        "NO_COLOR": "1",
    }
    done = subprocess.run(
        [str(installed / "bin" / "bulkcal"), *words],
        cwd=cwd,
        env=environment,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_wheel_holds_cases_templates_pages_and_licence(wheel: Path):
    names = set(zipfile.ZipFile(wheel).namelist())
    for wanted in (
        "calibrate/cases/proppants/hsp13_steel.toml",
        "calibrate/cases/proppants/angle_of_repose.csv",
        "calibrate/report/pages/report.html.j2",
        "liggghts_io/templates/heap.in.j2",
        "liggghts_io/templates/drum/experiment.toml",
        "liggghts_io/templates/drum/script.in.j2",
        "liggghts_io/templates/drum/meshes/drum.stl",
        "minidem/__init__.py",
    ):
        assert wanted in names
    assert any(name.endswith("LICENSE") for name in names)
    assert not any(name.startswith(("tests/", "benchmarks/")) for name in names)


def test_installed_packages_are_those_of_the_wheel(installed: Path, tmp_path: Path):
    code = "import calibrate, liggghts_io, minidem; print(calibrate.__file__, minidem.__file__)"
    done = subprocess.run(
        [str(installed / "bin" / "python"), "-c", code],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": sysconfig.get_path("purelib")},
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    )
    for place in done.stdout.split():
        assert Path(place).is_relative_to(installed)


def test_installed_command_generates_and_runs_a_case(installed: Path, tmp_path: Path):
    pairs = [word for value in PARAMETERS for word in ("-p", value)]
    tiny = [word for value in TINY for word in ("-a", value)]
    call(installed, tmp_path, "generate", "plate_impact", *pairs, *tiny, "--out", "case")
    result = json.loads(call(installed, tmp_path, "run", "case", "--json"))
    assert result["status"] == "ok"
    assert set(result["observables"]) == {"m1_g", "m2_g", "m3_g", "m4_g", "beside_g"}
    dumps = sorted((tmp_path / "case" / "output" / "post").glob("*"))
    assert dumps, "the engine wrote no dump"
    again = json.loads(call(installed, tmp_path, "post", "case", "--json"))
    assert again["observables"] == result["observables"]


def test_installed_command_knows_the_folders_of_the_program(installed: Path, tmp_path: Path):
    found = json.loads(call(installed, tmp_path, "apparatus", "tilting_plate", "--json"))
    assert [one["name"] for one in found["observables"]] == ["raft_angle_deg", "loose_angle_deg"]
    pairs = [word for value in PARAMETERS for word in ("-p", value)]
    call(installed, tmp_path, "generate", "drum", *pairs, "--out", "case")
    assert (tmp_path / "case" / "meshes" / "drum.stl").is_file()


def test_installed_demo_finds_the_bundled_study(installed: Path, tmp_path: Path):
    code = (
        "from calibrate.study.resources import bundled_study;"
        "from calibrate.study.load import load_study;"
        "print(load_study(bundled_study()).title)"
    )
    done = subprocess.run(
        [str(installed / "bin" / "python"), "-c", code],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": sysconfig.get_path("purelib")},
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    )
    assert done.stdout.strip() == "Carbo HSP13 on steel"
