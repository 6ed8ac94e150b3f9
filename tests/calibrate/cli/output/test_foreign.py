"""`bulkcal post` on output of other people's runs."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from liggghts_io import execute, read_experiment
from liggghts_io.case.spec import CaseSpec
from liggghts_io.materials import Particle
from tests.liggghts_io.foreign.grains import DATA, frame_text, known, write_frames
from tests.liggghts_io.own.folders import CONTACT, DEFINITION, make_folder

SLOPE_DEG = 30.0


def wedge(folder: Path) -> Path:
    """Write a heap whose flanks are known: grains of 1 mm below two lines."""
    d = 1e-3
    x, z = np.meshgrid(np.arange(-60, 61) * d / 2, (np.arange(40) + 1) * d / 2)
    inside = z <= 0.015 - np.abs(x) * np.tan(np.radians(SLOPE_DEG))
    x, z = x[inside], z[inside]
    columns = {"y": np.zeros(len(x)), "z": z, "x": x, "radius": np.full(len(x), d / 2)}
    (folder / "heap.dump").write_text(frame_text(5, columns))
    return folder


def test_without_options_it_tells_what_is_there(bulkcal):
    code, out, err = bulkcal("post", str(DATA))
    assert code == 0, err
    for word in ("post/f_*.dump", "post/v_*.vtp", "many.dump", "1000 to 2000", "KinEng", "radius"):
        assert word in out
    assert f"next: bulkcal post {DATA} --angle --frames last" in out
    told = json.loads(bulkcal("post", str(DATA), "--json")[1])
    assert told["dt_s"] == 1e-5
    assert told["dumps"][0]["name"] == "post/f_*.dump"
    assert {"name": "radius", "unit": "m", "least": 0.003, "largest": 0.003} in told["dumps"][0][
        "columns"
    ]


def test_the_angle_of_a_known_heap(bulkcal, tmp_path: Path):
    code, out, err = bulkcal("post", str(wedge(tmp_path)), "--angle", "--json")
    assert code == 0, err
    (row,) = json.loads(out)["table"]
    # Grains of a fiftieth of the base: steps of the outline turn the line by some tenths.
    assert row["angle_deg"] == pytest.approx(SLOPE_DEG, abs=1.0)
    assert row["step"] == 5


def test_a_mean_says_of_how_many_frames_it_is(bulkcal, tmp_path: Path):
    heap = wedge(tmp_path) / "heap.dump"
    nothing = {name: np.zeros(0) for name in ("y", "z", "x", "radius")}
    heap.write_text(frame_text(0, nothing) + heap.read_text() + heap.read_text())
    code, out, err = bulkcal("post", str(tmp_path), "--angle")
    assert code == 0, err
    assert "mean of up to 2 of 3 frames: angle_deg" in out


def test_contacts_are_no_grains_though_the_first_file_is_empty(bulkcal, tmp_path: Path):
    head = "# vtk DataFile Version 2.0\nx\nASCII\nDATASET POLYDATA\n"
    (tmp_path / "c_0.vtk").write_text(f"{head}POINTS 0 float\nPOINT_DATA 0\n")
    lines = "POINTS 2 float\n0 0 0\n0 0 1\nLINES 1 3\n2 0 1\n"
    (tmp_path / "c_100.vtk").write_text(f"{head}{lines}POINT_DATA 2\n")
    code, _, err = bulkcal("post", str(tmp_path), "--dump", "c_*.vtk", "--count")
    assert code == 2
    assert "c_*.vtk" in err


def test_columns_counts_and_masses_in_a_box(bulkcal, tmp_path: Path):
    write_frames(tmp_path, (50, 50, 50))
    words = ["--column", "z", "--column", "speed", "--count", "--mass", "--density", "2500"]
    table = tmp_path / "table.csv"
    code, _, err = bulkcal(
        "post", str(tmp_path), *words, "--box", "z=0:,x=-0.05:0.05", "--timestep", "1e-5",
        "--out", str(table),
    )  # fmt: skip
    assert code == 0, err
    found = pd.read_csv(table)
    assert found["step"].tolist() == [0, 1000, 2000]
    assert found["time_s"].tolist() == [0.0, 0.01, 0.02]
    for k, row in found.iterrows():
        one = pd.DataFrame(known(50, int(str(k))))
        one = one[(one.z >= 0.0) & one.x.between(-0.05, 0.05)]
        assert row["grains"] == len(one)
        assert row["mass_kg"] == pytest.approx(len(one) * 2500 * 4 / 3 * np.pi * 0.003**3)
        assert row["z_mean"] == pytest.approx(one.z.mean())
        assert row["z_median"] == pytest.approx(one.z.median())
        speed = np.sqrt(one.vx**2 + one.vy**2 + one.vz**2)
        assert row["speed_largest"] == pytest.approx(speed.max())


@pytest.mark.parametrize(
    ("frames", "steps"), [("last", [4]), ("0.5:1", [2, 3, 4]), (":0.3", [0, 1])]
)
def test_a_part_of_the_frames(bulkcal, tmp_path: Path, frames: str, steps: list[int]):
    text = "".join(frame_text(step, known(4)) for step in range(5))
    (tmp_path / "run.dump").write_text(text)
    code, out, err = bulkcal("post", str(tmp_path), "--count", "--frames", frames, "--json")
    assert code == 0, err
    assert [row["step"] for row in json.loads(out)["table"]] == steps


def test_a_size_may_be_given_by_hand(bulkcal, tmp_path: Path):
    text = (wedge(tmp_path) / "heap.dump").read_text()
    (tmp_path / "heap.dump").write_text(text.replace("radius", "c_1"))
    code, _, err = bulkcal("post", str(tmp_path), "--angle")
    assert code == 2
    assert "no column radius or diameter; give the grains' diameter with --diameter M" in err
    code, out, _ = bulkcal("post", str(tmp_path), "--angle", "--diameter", "1e-3", "--json")
    assert json.loads(out)["table"][0]["angle_deg"] == pytest.approx(SLOPE_DEG, abs=1.0)


MORE = """
[[observable]]
name = "mass_kg"
unit = "kg"
meaning = "mass of all grains"
extract = "mass"

[[observable]]
name = "z_m"
unit = "m"
meaning = "mean height in the second half"
extract = "grain_mean"
column = "z"
part = [0.5, 1.0]
box = { z = [0.0, "height_m + d32_m"] }
"""


def test_a_definition_measures_somebody_elses_run_as_its_own(bulkcal, tmp_path: Path):
    """The same numbers and curve without our records, and with parameters of one's own."""
    folder = make_folder(tmp_path / "rig", CONTACT + DEFINITION + MORE)
    grain = Particle("glass", d32_m=2e-3, density=2500.0)
    spec = CaseSpec(
        "fall", grain, "flat", "quick", {"mu_pp": 0.5, "e_pp": 0.6}, own=read_experiment(folder)
    )
    result = execute(spec, tmp_path / "runs")
    assert result.status == "ok", result.reason
    theirs = tmp_path / "theirs"
    shutil.copytree(result.path / "output", theirs)
    for name in ("end.json", "in.script"):
        (theirs / name).unlink()
    words = ["post", str(theirs), "--experiment", str(folder), "--density", "2500"]
    code, out, err = bulkcal(*words, "--json")
    assert code == 0, err
    told = json.loads(out)
    found = {row["observable"]: row["value"] for row in told["table"]}
    assert found == pytest.approx(dict(result.observables), rel=1e-12)
    assert told["curves"]["height"][0]["y"] == pytest.approx(20.0, rel=1e-3)
    assert bulkcal(*words, "--out", str(tmp_path / "t.csv"))[0] == 0
    assert len(pd.read_csv(tmp_path / "t_height.csv")) == len(told["curves"]["height"])
    higher = json.loads(bulkcal(*words, "-a", "height_m=0.03", "--json")[1])["table"]
    assert higher[0]["value"] < found["t_ground_s"]


def test_the_thermo_table_is_written(bulkcal, tmp_path: Path):
    table = tmp_path / "thermo.csv"
    assert bulkcal("post", str(DATA), "--thermo", "--out", str(table))[0] == 0
    assert pd.read_csv(table)["Step"].tolist()[-3:] == [1000, 2000, 2001]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--column", "vq"], "no column vq; did you mean 'vz'?"),
        (["--column", "z", "--dump", "post/g_*.dump"], "did you mean 'post/f_*.dump'?"),
        (["--angle", "--plane", "xy"], "unknown name 'xy'; known names: xz, yz"),
        (["--angle", "--box", "z=1"], "write AXIS=FROM:TO"),
        (["--angle", "--box", "z=2:1"], "write AXIS=FROM:TO"),
        (["--count", "--frames", "1:0"], "write all, last or FROM:TO"),
        (["--count", "--frames", "2"], "write all, last or FROM:TO"),
        (["--mass"], "a mass needs --density"),
        (["--count", "--out", "NEW/t.csv"], "there is no directory"),
        (["--count", "--out", "t.txt"], "ends in .csv"),
        (["--out", "t.csv"], "nothing is measured"),
        (["--units", "metric", "--count"], "units 'metric': cannot be converted"),
        (["--experiment", "nowhere"], "experiment.toml: cannot be read"),
        (["--count", "--box", "z=5:6", "--column", "z"], "no grain in the box"),
    ],
)
def test_a_mistake_is_told_and_nothing_is_written(
    bulkcal, tmp_path: Path, monkeypatch, words: list[str], message: str
):
    monkeypatch.chdir(tmp_path)
    code, out, err = bulkcal("post", str(DATA), "-q", *words)
    assert (code, out) == (2, "")
    assert message in err
    assert not list(tmp_path.iterdir())


def test_damage_in_the_midst_ends_with_its_line_and_no_table(bulkcal, tmp_path: Path):
    paths = write_frames(tmp_path)
    paths[1].write_text(paths[1].read_text().replace("0.003", "0.00x", 1))
    table = tmp_path / "table.csv"
    code, out, err = bulkcal("post", str(tmp_path), "--column", "z", "--out", str(table))
    assert (code, out) == (2, "")
    assert f"{paths[1]}:10: column radius: '0.00x' is not a number" in err
    assert not table.exists()


def test_a_damaged_dump_does_not_hide_the_others(bulkcal, tmp_path: Path):
    write_frames(tmp_path)
    (tmp_path / "other.dump").write_text("ITEM: TIMESTEP\nfour\n" * 9)
    code, out, err = bulkcal("post", str(tmp_path))
    assert code == 0
    assert "f_*.dump" in out
    assert "other.dump:2: expected a whole number" in err


def test_json_holds_no_number_that_json_does_not_know(bulkcal, tmp_path: Path):
    log = "LIGGGHTS (Version 3.8.0)\nStep Atoms KinEng\n 0 4 nan\n 5 4 -inf\nLoop\n"
    (tmp_path / "log.liggghts").write_text(log)
    code, out, err = bulkcal("post", str(tmp_path), "--thermo", "--json")
    assert code == 0, err
    told = json.loads(out, parse_constant=lambda word: pytest.fail(f"{word} is no JSON"))
    assert [row["KinEng"] for row in told["table"]] == [None, None]


def test_names_that_look_like_codes_of_a_terminal_are_shown_as_they_are(bulkcal, tmp_path: Path):
    """Files and columns of strangers have any names; brackets and colons mean nothing in tables."""
    names = ["id", "x", "y", "z", "c_[/b]", "c_:cat:"]
    columns = dict(zip(names, np.ones((6, 1)), strict=True))
    (tmp_path / "[red]a[").mkdir()
    (tmp_path / "[red]a[" / "]b\x1b[31m.dump").write_text(frame_text(0, columns))
    (tmp_path / "log.run").write_text("LIGGGHTS (Version)\nStep c_[/i]\n0 1\n1 2\nLoop\n")
    code, out, err = bulkcal("post", str(tmp_path))
    assert code == 0, err
    for word in ("[red]a[/]b\\x1b[31m.dump", "c_[/b]", "c_:cat:", "c_[/i]"):
        assert word in out
    assert bulkcal("post", str(tmp_path), "--thermo")[0] == 0
