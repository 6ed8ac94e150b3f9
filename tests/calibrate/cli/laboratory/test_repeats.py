"""Repeats count once and for their wall only, and commands at the same time lose none."""

from __future__ import annotations

import json
import stat
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from tests.calibrate.laboratory.logs import flow, written

BOXES = (
    "surface,run,m1_g\nsteel,1,30.4\nsteel,2,30.1\nsteel,3,30.2\nalumina,1,38.0\nalumina,2,38.3\n"
)
STEEL = np.mean([30.4, 30.1, 30.2])
ADD = ("measured", "add", "boxes.csv", "--column", "m1_g")
ANGLE = ("--unit", "deg", "--experiment", "heap", "--observable", "angle_deg")


@pytest.fixture
def bench(tmp_path: Path, monkeypatch) -> Path:
    """Go to an empty folder."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def mean_of(bulkcal, *words: str) -> float:
    return json.loads(bulkcal(*words, "--json")[1])["mean"]


@pytest.mark.parametrize("head", ["surface", "Surface", "Wand"])
def test_rows_of_the_wall_count_and_no_others(bench, bulkcal, head):
    Path("boxes.csv").write_text(BOXES.replace("surface", head))
    assert mean_of(bulkcal, *ADD, "--surface", "steel") == pytest.approx(STEEL)
    assert mean_of(bulkcal, *ADD, "--where", f"{head}=steel") == pytest.approx(STEEL)
    words = ("--surface", "plate 7", "--where", f"{head}=steel")  # the study calls it otherwise
    assert mean_of(bulkcal, *ADD, *words) == pytest.approx(STEEL)
    code, _, err = bulkcal(*ADD)
    assert code == 2
    assert "holds 'steel', 'alumina'; say whose rows count with --surface or --where" in err
    code, _, err = bulkcal(*ADD, "--surface", "stel")
    assert code == 2
    assert "did you mean 'steel'?" in err


def test_rows_of_the_material_count_and_no_others(bench, bulkcal):
    Path("boxes.csv").write_text("Material,m1_g\nSand,1.0\nSand,1.2\nGravel,5.0\nGravel,5.1\n")
    assert mean_of(bulkcal, *ADD, "--material", "sand") == pytest.approx(1.1)
    assert bulkcal(*ADD)[0] == 2


def test_groups_that_are_far_apart_are_told(bench, bulkcal):
    Path("boxes.csv").write_text("note,m1_g\nA,1.0\nA,1.2\nB,5.0\nB,5.1\n")
    code, _, err = bulkcal(*ADD)
    assert code == 0
    assert "repeats of 'A' and 'B' in column 'note' are 1.1 and 5.05" in err
    assert len(json.loads(bulkcal(*ADD, "--json")[1])["doubts"]) == 1


def test_a_table_of_one_wall_needs_no_name_of_it(bench, bulkcal):
    Path("boxes.csv").write_text("run,m1_g\n1,1.0\n2,1.2\n")
    assert mean_of(bulkcal, *ADD) == mean_of(bulkcal, *ADD, "--surface", "steel")


def test_a_column_of_units_is_heeded(bench, bulkcal):
    Path("boxes.csv").write_text("run,m1_g,unit\n1,0.0304,kg\n2,0.0301,kg\n")
    code, _, err = bulkcal(*ADD)
    assert code == 2
    assert "boxes.csv:2: unit = 'kg' but 'g' is said by" in err
    Path("boxes.csv").write_text("run,m1,Unit\n1,0.0304,kg\n2,0.0301,kg\n")
    words = ("measured", "add", "boxes.csv", "--column", "m1")
    assert json.loads(bulkcal(*words, "--json")[1])["unit"] == "kg"
    code, _, err = bulkcal(*words, "--unit", "g")
    assert code == 2
    assert "--unit g: column 'm1' is in kg" in err


@pytest.mark.parametrize("copied", ["bytes", "ends of lines", "decimals"])
def test_a_copied_log_is_no_repeat(bench, bulkcal, copied):
    text = written(Path("a.csv"), flow(np.random.default_rng(5))[0]).read_text()
    other = {
        "bytes": text,
        "ends of lines": text.replace("\n", "\r\n"),
        "decimals": "\n".join(
            [text.splitlines()[0], *(_rounded(line) for line in text.splitlines()[1:]), ""]
        ),
    }[copied]
    Path("b.csv").write_bytes(other.encode())
    code, _, err = bulkcal("measured", "scale", "a.csv", "b.csv")
    assert code == 2
    assert "b.csv: is the same log as a.csv; a repeat counts once" in err


def _rounded(line: str) -> str:
    return ",".join(f"{float(word):.1f}" for word in line.split(","))


def test_repeats_of_the_same_flow_are_no_copies(bench, bulkcal):
    for seed, name in ((5, "a.csv"), (6, "b.csv")):
        written(Path(name), flow(np.random.default_rng(seed))[0])
    assert bulkcal("measured", "scale", "a.csv", "b.csv")[0] == 0


def test_a_copied_photo_is_no_repeat(bench, bulkcal):
    Image.new("L", (64, 64), 200).save("a.png")
    Path("b.png").write_bytes(Path("a.png").read_bytes())
    for verb in (("size", "--scale", "20px/mm"), ("angle",)):
        code, _, err = bulkcal("photo", verb[0], "a.png", "b.png", *verb[1:])
        assert code == 2
        assert "b.png: is a copy of a.png; a repeat counts once" in err


def test_commands_at_the_same_time_lose_no_row(bench):
    """Eight processes that extend one table at once, each with its own row."""
    names = [f"a{k}" for k in range(8)]
    code = (
        "import os, sys\n"
        "from calibrate.cli.main import main\n"
        "import calibrate.laboratory.entries, calibrate.laboratory.targets\n"
        "for name in sys.argv[1:]:\n"
        "    if os.fork() == 0:\n"
        f"        words = ['measured', 'add', '34.2', '33.8', *{ANGLE!r}, '-q', '--out', 'm.csv']\n"
        "        try:\n"
        "            main([*words, '--name', name])\n"
        "        finally:\n"
        "            os._exit(0)\n"
        "for _ in sys.argv[1:]:\n"
        "    os.wait()\n"
    )
    subprocess.run([sys.executable, "-c", code, *names], check=True, stdout=subprocess.DEVNULL)
    rows = Path("m.csv").read_text().splitlines()[2:]
    assert sorted(row.partition(",")[0] for row in rows) == names
    assert [path.name for path in bench.iterdir()] == ["m.csv"]  # the lock is gone as well


def test_a_table_that_others_may_not_read_stays_so(bench, bulkcal):
    words = ("measured", "add", "34.2", "33.8", *ANGLE, "--out", "m.csv", "--name")
    assert bulkcal(*words, "a")[0] == 0
    Path("m.csv").chmod(0o600)
    assert bulkcal(*words, "b")[0] == 0
    assert stat.S_IMODE(Path("m.csv").stat().st_mode) == 0o600
