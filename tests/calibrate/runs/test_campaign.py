"""Campaigns: failures are rows, crashes are survived, interrupted work continues."""

from __future__ import annotations

import dataclasses
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from calibrate.errors import BugError, CalibrationError
from calibrate.runs.campaign import Campaign, Progress, run_table
from calibrate.runs.failures import failure_lines
from calibrate.study.resources import bundled_particles
from liggghts_io import CaseError, CaseResult, CaseSpec, particle_named
from tests.calibrate import stand_in
from tests.calibrate.runs import slow_sim
from tests.paths import ROOT
from tests.torture.arena import hear_ctrl_c

GRAIN = particle_named("Carbo HSP13", bundled_particles())
PARAMETERS = {
    "mu_pp": 0.5,
    "mu_roll_pp": 0.2,
    "mu_pw": 0.3,
    "mu_roll_pw": 0.2,
    "e_pp": 0.6,
    "e_pw": 0.6,
}


def specs(*seeds: int) -> list[CaseSpec]:
    return [CaseSpec("heap", GRAIN, "steel", "quick", PARAMETERS, seed=seed) for seed in seeds]


def ran(root: Path) -> list[int]:
    """Return the seeds that were really simulated, in order."""
    file = root / "ran.txt"
    return [int(line) for line in file.read_text().splitlines()] if file.exists() else []


def test_accidents_become_rows_and_the_rest_goes_on(tmp_path: Path):
    seeds = (1, slow_sim.FAILS, slow_sim.ALWAYS_DIES, slow_sim.DIES_ONCE, 2, 3)
    told: list[Progress] = []
    with Campaign(tmp_path, slow_sim.execute, workers=2, progress=told.append) as campaign:
        table = campaign(specs(*seeds), "accidents")
    assert table["seed"].tolist() == list(seeds)
    assert table["status"].tolist() == ["ok", "failed", "failed", "ok", "ok", "ok"]
    assert table["failure"].tolist() == ["", "physics", "killed", "", "", ""]
    reasons = dict(zip(table["seed"], table["reason"], strict=True))
    assert reasons[slow_sim.FAILS] == "step 12: particle 3 is lost"
    assert "was killed" in reasons[slow_sim.ALWAYS_DIES]
    assert table["angle_deg"].notna().sum() == 4
    assert (told[0].done, told[-1].done, told[-1].failed) == (0, 6, 2)
    assert told[-1].left_s == 0.0
    assert all(p.left_s is None or p.left_s >= 0.0 for p in told)
    # Nobody pays for the death of another: every seed ran once.
    assert sorted(ran(tmp_path)) == [1, 2, 3, slow_sim.DIES_ONCE]


def test_columns_of_the_table_do_not_depend_on_where_a_result_comes_from(tmp_path: Path):
    (heap,) = specs(1)
    plate = dataclasses.replace(heap, experiment="plate_impact")
    numbers = {"m1_g": 1.0, "m2_g": 2.0, "m3_g": 3.0, "m4_g": 4.0, "beside_g": 5.0}
    fresh = CaseResult("a", tmp_path, "ok", "", numbers, 1.0)
    stored = dataclasses.replace(fresh, observables=dict(sorted(numbers.items())))
    table = run_table([plate], [fresh])
    assert list(run_table([plate], [stored]).columns) == list(table.columns)
    assert list(table.columns)[-5:] == list(numbers)


def test_failures_are_told_with_class_reason_and_place(tmp_path: Path):
    told: list[str] = []
    with Campaign(tmp_path, slow_sim.execute, workers=2, tell=told.append) as campaign:
        table = campaign(specs(1, slow_sim.FAILS, slow_sim.ALWAYS_DIES), "accidents")
    head, *lines = failure_lines(table)
    assert told[0].endswith("it is tried again")
    assert told[1:] == [head, *lines]
    assert head == "2 of 3 runs failed: 1 physics, 1 killed"
    name = stand_in.case_id(specs(slow_sim.FAILS)[0])
    assert lines[0] == (
        f"  physics: step 12: particle 3 is lost (heap on steel, seed 901: {tmp_path / name})"
    )
    assert lines[1].startswith("  killed: the process of this run was killed")
    assert lines[2] == "  start the same command again to try again what was killed"
    assert failure_lines(table[table["status"] == "ok"]) == []


def test_full_disk_ends_the_campaign_with_a_remedy(tmp_path: Path):
    campaign = Campaign(tmp_path, slow_sim.execute, workers=1)
    with campaign, pytest.raises(CalibrationError, match=r"disk is full .*free some space"):
        campaign(specs(1, slow_sim.DISK_FULL, 2, 3), "full")
    assert ran(tmp_path) == [1]


def test_fault_of_the_program_ends_the_campaign_with_its_traceback(tmp_path: Path):
    campaign = Campaign(tmp_path, slow_sim.execute, workers=1)
    with campaign, pytest.raises(BugError, match="report it with the file"):
        campaign(specs(slow_sim.STUMBLES, 1), "stumbles")
    text = (tmp_path / "traceback.txt").read_text()
    assert "slow_sim.py" in text
    assert "IndexError: an index that nobody foresaw" in text
    assert ran(tmp_path) == []


def test_case_of_another_campaign_is_put_off_and_its_result_taken(tmp_path: Path):
    other, *rest = specs(1, 2, 3)
    stored: dict[int, CaseResult] = {}

    def held(spec: CaseSpec, root: Path) -> str | None:
        if spec.seed == other.seed and not stored:
            if sorted(ran(root)) == [2, 3]:  # the other campaign ends last of all
                stored[other.seed] = stand_in.execute(other, root)
            return "pid 1 on earth"
        return None

    campaign = Campaign(
        tmp_path, slow_sim.execute, workers=2, held=held,
        stored=lambda spec, _root: stored.get(spec.seed),
    )  # fmt: skip
    with campaign:
        table = campaign([other, *rest], "together")
    assert table["status"].tolist() == ["ok"] * 3
    assert sorted(ran(tmp_path)) == [2, 3]


def test_case_whose_holder_died_is_run(tmp_path: Path):
    told: list[str] = []
    since = time.monotonic()

    def held(_spec: CaseSpec, _root: Path) -> str | None:
        return "pid 1 on earth" if time.monotonic() - since < 1.5 else None

    with Campaign(tmp_path, slow_sim.execute, workers=1, held=held, tell=told.append) as campaign:
        table = campaign(specs(1), "waiting")
    assert table["status"].tolist() == ["ok"]
    assert ran(tmp_path) == [1]
    assert told == ["waiting for pid 1 on earth"]


def test_finished_cases_are_not_run_again_and_need_no_worker(tmp_path: Path):
    with Campaign(tmp_path, slow_sim.execute, workers=1) as campaign:
        first = campaign(specs(1, 2), "first")
    started = time.monotonic()
    with Campaign(tmp_path, slow_sim.execute, stored=stand_in.stored, workers=1) as campaign:
        again = campaign(specs(2, 1), "again")
    # Starting a worker process costs more than half a second; reading two files does not.
    assert time.monotonic() - started < 0.5
    assert ran(tmp_path) == [1, 2]
    assert again["angle_deg"].tolist() == first["angle_deg"].tolist()[::-1]


def test_impossible_case_stops_the_campaign_at_once(tmp_path: Path):
    campaign = Campaign(tmp_path, slow_sim.execute, workers=1)
    with campaign, pytest.raises(CaseError, match="mu_pp = -1"):
        campaign(specs(slow_sim.IMPOSSIBLE, 1, 2), "impossible")
    assert ran(tmp_path) == []


def test_any_executor_will_do(tmp_path: Path):
    with ThreadPoolExecutor(2) as pool, Campaign(
        tmp_path, slow_sim.execute, workers=2, executor=pool
    ) as campaign:  # fmt: skip
        table = campaign(specs(1, 2, 3), "threads")
        assert pool.submit(int, "7").result() == 7  # the campaign did not close it
    assert table["status"].tolist() == ["ok"] * 3


DRIVER = """
from pathlib import Path
from tests.calibrate.runs import slow_sim
from tests.calibrate.runs.test_campaign import specs
from calibrate.runs.campaign import Campaign
if __name__ == "__main__":
    slow_sim.SLOW_S = 0.5
    with Campaign(Path({root!r}), slow_sim.execute, workers=2) as campaign:
        campaign(specs(*range(1, 9)), "driver")
"""


def start_driver(root: Path) -> subprocess.Popen[bytes]:
    """Start a campaign of eight slow cases in its own process and wait for the first results."""
    script = root.parent / "driver.py"
    script.write_text(DRIVER.format(root=str(root)))
    process = subprocess.Popen(
        [sys.executable, str(script)],
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        stderr=subprocess.PIPE,
        start_new_session=True,
        preexec_fn=hear_ctrl_c,
    )
    deadline = time.monotonic() + 60.0
    while len(ran(root)) < 2:
        assert process.poll() is None, process.stderr.read() if process.stderr else ""
        assert time.monotonic() < deadline, "no result after a minute"
        time.sleep(0.02)
    return process


def workers_of(process: subprocess.Popen[bytes]) -> list[int]:
    """Return the processes of the session that `process` leads, without itself."""
    found = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit() and int(entry.name) != process.pid:
            try:
                fields = (entry / "stat").read_text().rpartition(")")[2].split()
            except OSError:
                continue
            if int(fields[3]) == process.pid and fields[0] != "Z":
                found.append(int(entry.name))
    return found


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="reads processes from /proc")
@pytest.mark.parametrize("kill", [signal.SIGKILL, signal.SIGINT], ids=["kill -9", "Ctrl-C"])
def test_killed_campaign_leaves_nobody_behind_and_continues(kill, tmp_path: Path):
    root = tmp_path / "runs"
    root.mkdir()
    process = start_driver(root)
    assert workers_of(process), "the workers should be there before the kill"
    process.send_signal(kill)
    process.wait(timeout=20)
    if process.stderr:
        process.stderr.close()
    deadline = time.monotonic() + 20.0
    while workers_of(process) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert workers_of(process) == []
    before = ran(root)
    assert 2 <= len(before) < 8
    with Campaign(root, slow_sim.execute, stored=stand_in.stored, workers=2) as campaign:
        table = campaign(specs(*range(1, 9)), "continued")
    assert table["status"].tolist() == ["ok"] * 8
    finished = [s.seed for s in specs(*range(1, 9))]
    assert sorted(set(ran(root))) == finished
    # At most the two runs under way when it was killed are done twice.
    assert len(ran(root)) <= 10


def test_killed_worker_is_replaced(tmp_path: Path):
    """A worker killed from outside (out of memory, say) costs no case."""
    import multiprocessing

    killed: list[int] = []

    def kill_one(progress: Progress) -> None:
        if progress.done == 1 and not killed:
            child = multiprocessing.active_children()[0]
            killed.append(child.pid or 0)
            os.kill(child.pid or 0, signal.SIGKILL)

    with Campaign(tmp_path, slow_sim.execute, workers=1, progress=kill_one) as campaign:
        table = campaign(specs(1, 2, 3, 4), "killed worker")
    assert killed
    assert table["status"].tolist() == ["ok"] * 4
