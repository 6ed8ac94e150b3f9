"""`bulkcal measured` and `bulkcal motion`, end to end: logs in, a study out."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path

import numpy as np
import pytest

from calibrate.study.data import load_data
from tests.calibrate.laboratory.logs import flow, written
from tests.calibrate.laboratory.test_motion import record

STUDY = """
name = "own"
title = "Own logs"

[[material]]
name = "Sand"
d32_um = 1500.0
density_kg_m3 = 2500.0
flow_flat_g_s = 20.0

[[surface]]
name = "steel"

[parameter.mu_pp]
range = [0.1, 0.8]
"""
FIXED = "".join(
    f"\n[parameter.{name}]\nvalue = 0.5\n"
    for name in ("mu_roll_pp", "mu_pw", "mu_roll_pw", "e_pp", "e_pw")
)
PNG = b"\x89PNG\r\n"


@pytest.fixture
def bench(tmp_path: Path, monkeypatch) -> Path:
    """Go to a folder with three logs of one flow."""
    monkeypatch.chdir(tmp_path)
    rng = np.random.default_rng(21)
    for k in (1, 2, 3):
        written(tmp_path / f"run{k}.csv", flow(rng, onset=4.5 + 0.1 * k)[0])
    return tmp_path


RUNS = ("run1.csv", "run2.csv", "run3.csv")
INTO = ("--out", "measured.csv", "--name", "t100_steel", "--surface", "steel")


def printed_study(out: str) -> str:
    """Return the lines of a study in what a command printed."""
    return out[out.index("[[") :]


def files(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_logs_become_a_target_that_a_study_reads(bench, bulkcal):
    code, out, _ = bulkcal("measured", "scale", *RUNS, "--mass", "100g", *INTO)
    assert code == 0
    assert "3 logs" in out
    assert (bench / "t100_steel.png").read_bytes().startswith(PNG)
    (bench / "own.toml").write_text(STUDY + FIXED + printed_study(out))
    found = load_data(bench / "own.toml").scalars["t100_steel"]
    shown = json.loads(bulkcal("measured", "scale", *RUNS, "--json")[1])
    assert found.value == pytest.approx(shown["value"], rel=1e-6)
    assert found.se == pytest.approx(shown["se"], rel=1e-3)
    assert found.repeats == shown["repeats"] == 3
    code, out, _ = bulkcal("check", "own.toml", "-q")
    assert code == 0
    assert "no mistake found" in out
    times = [one["time_s"]["value"] for one in shown["logs"]]
    assert shown["value"] == pytest.approx(np.mean(times))
    assert shown["se"] == pytest.approx(np.std(times, ddof=1) / 3**0.5)


def test_a_curve_becomes_a_target_that_a_study_reads(bench, bulkcal):
    words = ("--curve", "--out", "curve.csv", "--name", "curve", "--plot", "c.png")
    code, out, _ = bulkcal("measured", "scale", *RUNS, *words)
    assert code == 0
    (bench / "own.toml").write_text(STUDY + FIXED + printed_study(out))
    curve = load_data(bench / "own.toml").curves["curve"]
    assert curve.repeats == 3
    assert curve.levels.tolist() == [10.0 * k for k in range(1, 11)]
    shown = json.loads(bulkcal("measured", "scale", *RUNS, "--json")[1])
    assert curve.values[-1] == pytest.approx(shown["value"], rel=1e-5)
    assert bulkcal("measured", "scale", *RUNS, *words[:-1], "d.png")[0] == 2  # stays as it is


def test_a_table_is_extended_and_a_second_entry_of_a_name_refused(bench, bulkcal):
    assert bulkcal("measured", "scale", *RUNS, *INTO, "-q")[0] == 0
    angle = ("--out", "measured.csv", "--name", "angle", "--experiment", "heap")
    values = ("measured", "add", "34,2", "33,8", "34,6", "--unit", "deg")
    code, out, _ = bulkcal(*values, *angle, "--observable", "angle_deg")
    assert code == 0
    assert "34.2 ± 0.231 deg, 3 repeats" in out
    table = (bench / "measured.csv").read_bytes()
    assert table.count(b"\n") == 4
    before = files(bench)
    for words in (INTO, (*INTO, "--plot", "other.png")):
        code, _, err = bulkcal("measured", "scale", *RUNS, *words)
        assert code == 2
        assert "exists already" in err or "has 't100_steel' already" in err
    assert (bench / "measured.csv").read_bytes() == table
    assert files(bench) == before


def test_another_mass_changes_the_apparatus_too(bench, bulkcal):
    words = ("--mass", "50 g", "--out", "m.csv", "--name", "t50", "--json")
    study = json.loads(bulkcal("measured", "scale", *RUNS, *words)[1])["study"]
    assert tomllib.loads(study)["experiment"][0]["apparatus"] == {"target_mass_kg": 0.05}


def test_one_log_tells_no_scatter(bench, bulkcal):
    out = bulkcal("measured", "scale", "run1.csv")[1]
    assert "how far repeats scatter is not known" in out
    assert files(bench) == sorted(RUNS)


MISTAKES = {
    "no log": (("nothing.csv",), "nothing.csv: cannot be read"),
    "a folder": ((".",), "it is a directory"),
    "twice": (("run1.csv", "run1.csv"), "is the same log as run1.csv; a repeat counts once"),
    "mass without unit": (("run1.csv", "--mass", "100"), "--mass 100: give a mass above zero"),
    "mass of nothing": (("run1.csv", "--mass", "0g"), "--mass 0g: give a mass above zero"),
    "mass in metres": (("run1.csv", "--mass", "1m"), "such as 100g or 0.1kg"),
    "too much": (("run1.csv", "--mass", "1kg"), "run1.csv: 300 g lie on the scale at the end"),
    "quantity": (("run1.csv", "--quantity", "slop"), "did you mean 'slope'?"),
    "column": (("run1.csv", "--mass-column", "mas"), "no column 'mas'; it has time [s], mass [g]"),
    "starts": ((*RUNS, "--start", "1", "--start", "2"), "--start: 2 times for 3 logs"),
    "no name": (("run1.csv", "--out", "m.csv"), "--name: is missing"),
    "no folder": (("run1.csv", "--out", "x/m.csv", "--name", "t"), "no directory x; make it"),
    "experiment": (
        ("run1.csv", "--out", "m.csv", "--name", "t", "--experiment", "convyor"), "'conveyor'?",
    ),
    "observable": (
        ("run1.csv", "--out", "m.csv", "--name", "t", "--quantity", "slope"), "--observable: is",
    ),
    "wrong unit": (
        ("run1.csv", "--out", "m.csv", "--name", "t", "--quantity", "slope", "--observable",
         "t100_s"), "'g/s' is not a known unit",
    ),
    "jpeg": (("run1.csv", "--plot", "a.jpg"), "pictures are PNG"),
}  # fmt: skip


@pytest.mark.parametrize("name", MISTAKES)
def test_a_mistake_is_one_message_and_nothing_is_written(bench, bulkcal, name):
    words, told = MISTAKES[name]
    code, out, err = bulkcal("measured", "scale", *words)
    assert (code, out) == (2, "")
    assert told in err
    assert "Traceback" not in err
    assert files(bench) == sorted(RUNS)


VALUES = {
    "one": (("1.0",), "two repeats are the fewest"),
    "word": (("1.0", "abc"), "'abc' is not a number"),
    "no column": (("run1.csv",), "--column: is missing"),
    "where": (("run1.csv", "--column", "mass", "--where", "x"), "--where x: write --where column="),
    "se of several": (("1", "2", "--se", "0.1"), "--se 0.1: belongs to one number"),
    "se": (("1", "--se", "-0.1"), "is not a positive number"),
    "repeats": (("1", "2", "--repeats", "3"), "--repeats 3: belongs to --se"),
    "no unit": (("1", "2", "--out", "m.csv", "--name", "a", "--experiment", "heap", "--observable",
                 "angle_deg"),
                "--unit: is missing"),
    "no name": (("1", "2", "--out", "m.csv"), "--name: is missing"),
    "no experiment": (("1", "2", "--out", "m.csv", "--name", "a"), "--experiment: give a name"),
    "unit": (("1", "2", "--unit", "s", "--out", "m.csv", "--name", "a", "--experiment", "heap",
              "--observable", "angle_deg"), "'s' is a unit of time"),
}  # fmt: skip


@pytest.mark.parametrize("name", VALUES)
def test_a_mistake_in_values_is_one_message_too(bench, bulkcal, name):
    words, told = VALUES[name]
    code, out, err = bulkcal("measured", "add", *words)
    assert (code, out) == (2, "")
    assert told in err
    assert files(bench) == sorted(RUNS)


def test_a_number_with_its_error_and_json(bench, bulkcal):
    words = ("10.13", "--se", "0.06", "--repeats", "5", "--unit", "s", "--json")
    found = json.loads(bulkcal("measured", "add", *words)[1])
    assert (found["mean"], found["se"], found["repeats"]) == (10.13, 0.06, 5)


def test_a_full_disk_leaves_the_table_and_no_picture(bench, bulkcal, monkeypatch):
    from calibrate.cli.laboratory import options

    assert bulkcal("measured", "scale", *RUNS, *INTO)[0] == 0
    before, there = (bench / "measured.csv").read_bytes(), files(bench)
    write = options.write_bytes

    def full(path: Path, content: bytes) -> None:
        if path.suffix == ".csv":
            raise OSError(28, "No space left on device", str(path))
        write(path, content)

    monkeypatch.setattr(options, "write_bytes", full)
    words = ("--out", "measured.csv", "--name", "t2")
    assert bulkcal("measured", "scale", *RUNS, *words)[0] == 2
    assert (bench / "measured.csv").read_bytes() == before
    assert files(bench) == there


def test_the_group_shows_its_help_and_knows_its_verbs(bulkcal):
    code, out, _ = bulkcal("measured")
    assert code == 0
    assert "scale" in out
    assert "add" in out
    code, _, err = bulkcal("measured", "scales")
    assert code == 2
    assert "No such command" in err
    assert "(see: bulkcal measured scale --help)" in bulkcal("measured", "scale", "--no")[2]


def test_quiet_may_stand_in_front(bench, bulkcal):
    out = bulkcal("-q", "measured", "scale", "run1.csv")[1]
    assert "how far repeats scatter" not in out
    assert "time of 100 g" in out


def test_a_profile_becomes_an_apparatus_that_a_study_takes(tmp_path, bulkcal, monkeypatch):
    monkeypatch.chdir(tmp_path)
    record(tmp_path / "plate.csv", np.random.default_rng(22))
    found = json.loads(bulkcal("motion", "plate.csv", "--json")[1])
    assert found["worth_keeping"] == len(found["harmonics"]) == 3
    assert (tmp_path / "plate_motion.png").read_bytes().startswith(PNG)
    target = '\n[[target]]\nexperiment = "conveyor"\nobservable = "t100_s"\nunit = "s"\n'
    target += "value = 10.0\nse = 0.1\n"
    (tmp_path / "own.toml").write_text(STUDY + FIXED + target + found["study"])
    apparatus = load_data(tmp_path / "own.toml").study.overrides("conveyor")
    assert apparatus["amplitude_m"] == pytest.approx(2e-3, rel=0.02)
    code, out, _ = bulkcal("motion", "plate.csv", "--period", "81.2ms", "--harmonics", "2")
    assert code == 0
    assert "viblin axis 1 0 0 order 2 amplitude" in out
    # Drawn once more, and a picture that somebody else drew is left alone.
    (tmp_path / "plate_motion.png").write_bytes(b"mine")
    code, _, err = bulkcal("motion", "plate.csv")
    assert (code, "was not drawn by bulkcal; name another file with --plot" in err) == (2, True)
    assert (tmp_path / "plate_motion.png").read_bytes() == b"mine"


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("nothing.csv",), "nothing.csv: cannot be read"),
        (("plate.csv", "--period", "0.08"), "--period 0.08: give a time above zero with its unit"),
        (("plate.csv", "--period", "-1s"), "give a time above zero"),
        (("plate.csv", "--period", "9s"), "--period 9s: the record holds"),
        (("plate.csv", "--unit", "furlong"), "--unit furlong: unknown name"),
        (("plate.csv", "--harmonics", "31"), "--harmonics"),
        (("plate.csv", "--plot", "plate.csv"), "pictures are PNG"),
    ],
)
def test_a_mistake_in_a_profile_is_one_message(tmp_path, bulkcal, monkeypatch, words, told):
    monkeypatch.chdir(tmp_path)
    record(tmp_path / "plate.csv", np.random.default_rng(23))
    code, out, err = bulkcal("motion", *words)
    assert (code, out) == (2, "")
    assert told in err
    assert files(tmp_path) == ["plate.csv"]
