"""The commands `challenge ...` on wrong input: one message with a remedy, nothing written."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.paths import ROOT

RULES = ROOT / "cases" / "challenge" / "dev.toml"


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("make nowhere.toml", "nowhere.toml"),
        ("make broken.toml", "single"),
        ("make rules.toml", "give --seed TEXT"),
        ("make lonely.toml --seed a", "study.toml"),
        ("forecast empty --rules nowhere.toml", "nowhere.toml: No such file"),
        ("forecast sealed --rules rules.toml", "r.csv: no table of runs"),
        ("forecast empty --rules rules.toml", "'bulkcal challenge make' writes one"),
        ("forecast empty --rules rules.toml --method orcale", "did you mean 'oracle'"),
        ("score empty --rules rules.toml --forecasts rules.zip", "no archive of forecasts"),
        ("score empty --rules rules.toml", "bulkcal challenge forecast empty"),
        ("score sealed --rules rules.toml", "truths.json: No such file"),
        ("score opened --rules rules.toml", "sealed.json: holds no digests"),
    ],
)
def test_a_mistake_is_told_with_its_remedy(bulkcal, tmp_path, monkeypatch, words, said):
    monkeypatch.chdir(tmp_path)
    good = f'name = "a"\nstudy = "{RULES.parent}/one_material.toml"\nruns = "r.csv"\n'
    (tmp_path / "rules.toml").write_text(good, encoding="utf-8")
    (tmp_path / "broken.toml").write_text(good + "single = -1\n", encoding="utf-8")
    lonely = 'name = "a"\nstudy = "study.toml"\nruns = "r.csv"\n'
    (tmp_path / "lonely.toml").write_text(lonely, encoding="utf-8")
    (tmp_path / "empty").mkdir()
    study = tmp_path / "sealed" / "studies" / "study_0001"
    study.mkdir(parents=True)
    (study / "study.toml").touch()
    (tmp_path / "sealed" / "sealed.json").write_text('{"digests": {}}', encoding="utf-8")
    for suite in ("sealed", "opened"):
        (tmp_path / suite / "forecasts" / "ours").mkdir(parents=True)
    for record in ("sealed.json", "truths.json"):
        (tmp_path / "opened" / record).write_text("{}", encoding="utf-8")
    before = sorted(tmp_path.rglob("*"))
    code, _, err = bulkcal("challenge", *words.split())
    assert code == 2, err
    assert said in err
    assert "Traceback" not in err
    assert sorted(tmp_path.rglob("*")) == before


def test_help_names_the_verbs(bulkcal):
    code, out, _ = bulkcal("challenge", "--help")
    assert code == 0
    assert all(verb in out for verb in ("make", "forecast", "score"))


POOL = """
import os, sys, time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from calibrate.cli.challenge.forecast import _prepare

if __name__ == "__main__":
    with ProcessPoolExecutor(1, get_context("spawn"), initializer=_prepare) as pool:
        print(pool.submit(os.getpid).result(), flush=True)
        pool.submit(time.sleep, 600).result()
"""


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="finds processes by /proc")
def test_a_killed_forecast_leaves_nobody_behind(tmp_path):
    script = tmp_path / "pool.py"
    script.write_text(POOL, encoding="utf-8")
    env = os.environ | {"PYTHONPATH": str(ROOT)}
    command = [sys.executable, str(script)]
    with subprocess.Popen(command, env=env, stdout=subprocess.PIPE, text=True) as pool:
        assert pool.stdout is not None
        worker = int(pool.stdout.readline())
        assert Path(f"/proc/{worker}").exists()
        pool.kill()
    until = time.monotonic() + 20.0  # it takes a moment; a busy machine may take some
    while _lives(worker) and time.monotonic() < until:
        time.sleep(0.05)
    assert not _lives(worker)


def _lives(process: int) -> bool:
    """Whether a process runs; one that ended and that nobody has asked for does not."""
    try:
        stat = Path(f"/proc/{process}/stat").read_text()
    except (FileNotFoundError, ProcessLookupError):
        return False
    return stat.rpartition(")")[2].split()[0] != "Z"
