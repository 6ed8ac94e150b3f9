"""The commands for single cases, used twice at once, too early, and in a directory of old files."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.liggghts_io.conftest import PARAMETERS, SMALL, TIMED
from tests.paths import ROOT

COMMAND = [sys.executable, "-c", "from calibrate.cli.main import main; main()"]


def words_of(experiment: str, **apparatus: float) -> list[str]:
    """Return the command that generates a small case."""
    values = {**(TIMED if experiment == "conveyor" else SMALL[experiment]), **apparatus}
    words = ["generate", experiment]
    for name, value in PARAMETERS.items():
        words += ["-p", f"{name}={value}"]
    for name, value in values.items():
        words += ["-a", f"{name}={value}"]
    return words


def start_waiting(*words: str) -> subprocess.Popen[str]:
    """Start a command in a process that has loaded everything and waits for a line."""
    code = (
        "from calibrate.cli.main import main; import calibrate.cli.show.progress, minidem\n"
        "print('ready', flush=True); input(); main()"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", code, *words], cwd=ROOT, text=True,
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    assert process.stdout is not None
    assert process.stdout.readline() == "ready\n"
    return process


def release(process: subprocess.Popen[str]) -> None:
    """Let a waiting command begin."""
    assert process.stdin is not None
    process.stdin.write("go\n")
    process.stdin.flush()


def wait_for_frames(case: Path, count: int, process: subprocess.Popen[str]) -> None:
    """Wait until a run has written some frames; a run that ended before is a failure."""
    while len(list(case.rglob("frame_*.dump"))) < count:
        assert process.poll() is None, "the run ended before"
        time.sleep(0.001)


def observables(text: str) -> dict[str, float]:
    return json.loads(text)["observables"]


def test_generate_takes_measured_and_coarse_grains(bulkcal, tmp_path: Path) -> None:
    words = (*words_of("heap"), "--sizes", "measured", "--coarse-graining", "1.5")
    code, _, text = bulkcal(*words, "--out", str(tmp_path / "a"))
    assert code == 0, text
    text = (tmp_path / "a" / "in.script").read_text()
    assert "1.5 times that of the real ones, 3 classes from" in text
    for wrong, reason in ((("--sizes", "some"), "'one' or 'measured'"),
                          (("--coarse-graining", "3"), "e_pp = 0.742")):  # fmt: skip
        code, _, told = bulkcal(*words_of("heap"), *wrong, "--out", str(tmp_path / "b"))
        assert code == 2
        assert reason in " ".join(told.split())
        assert not (tmp_path / "b").exists()


def test_a_case_that_is_run_twice_at_once_is_right_twice(bulkcal, tmp_path: Path) -> None:
    """One engine once truncated the files that the other read: 12.87 s instead of 9.89 s."""
    for name in ("truth", "case"):
        words = [
            *words_of("conveyor", frames=60.0, width_fraction=0.3),
            "--out",
            str(tmp_path / name),
        ]
        assert bulkcal(*words)[0] == 0
    truth = observables(bulkcal("run", str(tmp_path / "truth"), "--json")[1])
    first, second = (start_waiting("run", str(tmp_path / "case"), "--json") for _ in range(2))
    release(first)
    wait_for_frames(tmp_path / "case", 20, first)  # of 61
    release(second)
    results = [json.loads(one.communicate()[0]) for one in (first, second)]
    assert results[0]["observables"] == truth
    assert results[0] == results[1]  # one run, with one duration


@pytest.mark.parametrize("experiment", ["conveyor", "plate_impact"])
def test_post_refuses_a_run_that_was_killed(bulkcal, tmp_path: Path, experiment: str) -> None:
    """Half a plate impact once gave 8.64 g instead of 18.16 g, with exit code 0."""
    case = tmp_path / "case"
    bulkcal(*words_of(experiment, frames=100.0), "--out", str(case))
    run = subprocess.Popen(
        [*COMMAND, "run", str(case)], cwd=ROOT, text=True, stderr=subprocess.DEVNULL
    )
    wait_for_frames(case, 40, run)
    run.kill()
    run.wait()
    code, out, err = bulkcal("post", str(case))
    assert (code, out) == (2, "")
    assert "the last run stopped at step" in err
    assert bulkcal("run", str(case))[0] == 0


def test_old_results_are_not_given_a_new_name(bulkcal, tmp_path: Path) -> None:
    case = tmp_path / "case"
    words = [*words_of("heap"), "--out", str(case)]
    bulkcal(*words)
    first = observables(bulkcal("run", str(case), "--json")[1])
    for more in (["--seed", "2"], ["-a", "frames=20"], ["--engine", "liggghts"]):
        code, _, err = bulkcal(*words, *more)
        assert code == 2
        assert "holds results of another case" in err
    assert observables(bulkcal("post", str(case), "--json")[1]) == first
    (case / "in.script").write_text("")
    for verb in ("run", "post"):
        code, _, err = bulkcal(verb, str(case))
        assert code == 2
        assert "in.script: is empty" in err


def test_running_again_is_asked_for(bulkcal, tmp_path: Path) -> None:
    case = tmp_path / "case"
    bulkcal(*words_of("plate_impact"), "--out", str(case))
    bulkcal("run", str(case))
    before = (case / "result.json").read_bytes()
    code, out, err = bulkcal("run", str(case))
    assert code == 0
    assert "beside_g" in out
    assert "the stored result is shown; --again runs it again" in err
    assert (case / "result.json").read_bytes() == before
    bulkcal("run", str(case), "--again")
    assert (case / "result.json").read_bytes() != before  # another duration at least
