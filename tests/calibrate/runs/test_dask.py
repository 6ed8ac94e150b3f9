"""Campaigns on a real Dask cluster: killed workers, a killed scheduler, Ctrl-C, two campaigns."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from collections import Counter
from pathlib import Path

import pytest

from calibrate.errors import CalibrationError
from calibrate.runs.campaign import Campaign, Progress
from calibrate.runs.executors.choose import executor_of
from calibrate.runs.others import held_case
from liggghts_io import CaseError
from tests.calibrate.runs import dask_cluster as there
from tests.calibrate.runs.test_campaign import specs, workers_of
from tests.paths import ROOT
from tests.torture.arena import hear_ctrl_c

pytest.importorskip("distributed")
SEEDS = tuple(range(1, 9))


def campaign(root: Path, executor, **words) -> Campaign:
    return Campaign(
        root, there.execute, stored=there.stored, held=held_case, executor=executor,
        workers=executor.workers, **words,
    )  # fmt: skip


def test_killed_worker_costs_its_own_run_only(tmp_path: Path):
    killed: list[int] = []
    told: list[str] = []

    def kill_one(progress: Progress) -> None:
        if progress.done == 2 and not killed:
            there.wait_until(lambda: len(there.starts(tmp_path)) >= 3)
            seed, process = there.starts(tmp_path)[-1]
            os.kill(process, signal.SIGKILL)
            killed.append(seed)

    with executor_of("dask-local", 2) as executor, campaign(
        tmp_path, executor, progress=kill_one, tell=told.append
    ) as runs:  # fmt: skip
        table = runs(specs(*SEEDS), "killed worker")
    assert table["status"].tolist() == ["ok"] * len(SEEDS)
    count = Counter(seed for seed, _ in there.starts(tmp_path))
    assert count == {seed: 2 if seed in killed else 1 for seed in SEEDS}
    assert [line.endswith("it is tried again") for line in told] == [True]
    assert "was killed, or ran out of memory" in told[0]


def test_killed_scheduler_ends_the_campaign_and_it_goes_on_when_started_again(tmp_path: Path):
    port = there.free_port()
    with there.Cluster(port) as cluster:
        cluster.start(2)
        executor = wait_for_workers(cluster.name, 2)

        def kill_scheduler(progress: Progress) -> None:
            if progress.done == 2:
                cluster.scheduler.kill()

        with (
            pytest.raises(CalibrationError, match=r"scheduler is gone.*start the same command"),
            executor,
            campaign(tmp_path, executor, progress=kill_scheduler) as runs,
        ):
            runs(specs(*SEEDS), "first")
        before = there.starts(tmp_path)
        assert 2 <= len(before) < len(SEEDS)
    # The workers of the dead scheduler were killed in the middle of at most two runs.
    finished = {s.seed for s in specs(*SEEDS) if there.stored(s, tmp_path) is not None}
    with there.Cluster(port) as cluster:
        cluster.start(2)
        executor = wait_for_workers(cluster.name, 2)
        with executor, campaign(tmp_path, executor) as runs:
            table = runs(specs(*SEEDS), "again")
    assert table["status"].tolist() == ["ok"] * len(SEEDS)
    count = Counter(seed for seed, _ in there.starts(tmp_path))
    assert set(count) == set(SEEDS)
    assert all(count[seed] == 1 for seed in finished)
    assert sum(count.values()) <= len(SEEDS) + 2


def wait_for_workers(name: str, count: int):
    """Return an executor on a cluster once all its workers are there."""
    found = []

    def there_are_enough() -> bool:
        for one in found:
            one.close(at_once=True)
        found.clear()
        try:
            found.append(executor_of(name))
        except CalibrationError:
            return False
        return found[0].workers == count

    there.wait_until(there_are_enough)
    return found[0]


DRIVER = """
import sys
from pathlib import Path
from calibrate.runs.executors.choose import executor_of
from tests.calibrate.runs.test_campaign import specs
from tests.calibrate.runs.test_dask import campaign, SEEDS
if __name__ == "__main__":
    with executor_of("dask-local", 2) as executor, campaign(Path(sys.argv[1]), executor) as runs:
        runs(specs(*SEEDS), "driver")
"""


def start_driver(root: Path) -> subprocess.Popen[bytes]:
    """Start a campaign on a Dask cluster of its own in a process of its own."""
    script = root.parent / "driver.py"
    script.write_text(DRIVER)
    return subprocess.Popen(
        [sys.executable, str(script), str(root)], env={**os.environ, "PYTHONPATH": str(ROOT)},
        stderr=subprocess.PIPE, start_new_session=True, preexec_fn=hear_ctrl_c,
    )  # fmt: skip


@pytest.mark.parametrize("kill", [signal.SIGINT, signal.SIGKILL], ids=["Ctrl-C", "kill -9"])
def test_interrupted_campaign_leaves_no_worker_behind_and_continues(kill, tmp_path: Path):
    root = tmp_path / "runs"
    root.mkdir()
    process = start_driver(root)
    there.wait_until(lambda: len(there.starts(root)) >= 2)
    if kill == signal.SIGINT:
        os.killpg(process.pid, kill)  # as a terminal does, to every process
    else:
        process.kill()
    _, err = process.communicate(timeout=30)
    there.wait_until(lambda: workers_of(process) == [], 30.0)
    if kill == signal.SIGINT:
        assert err.decode().count("Traceback") == 1, err.decode()
        assert err.decode().rstrip().endswith("KeyboardInterrupt")
    assert len(there.starts(root)) < len(SEEDS)
    with Campaign(root, there.execute, stored=there.stored, workers=2) as runs:
        table = runs(specs(*SEEDS), "continued")
    assert table["status"].tolist() == ["ok"] * len(SEEDS)
    assert len(there.starts(root)) <= len(SEEDS) + 2


def test_two_campaigns_on_one_root_run_every_case_once(tmp_path: Path):
    process = start_driver(tmp_path)
    with Campaign(
        tmp_path, there.execute, stored=there.stored, held=held_case, workers=2
    ) as runs:  # fmt: skip
        table = runs(specs(*SEEDS), "beside")
    _, err = process.communicate(timeout=60)
    assert process.returncode == 0, err.decode()
    assert table["status"].tolist() == ["ok"] * len(SEEDS)
    assert Counter(seed for seed, _ in there.starts(tmp_path)) == dict.fromkeys(SEEDS, 1)


def test_scheduler_that_is_not_there_or_has_no_workers_is_named(monkeypatch):
    from calibrate.runs.executors import clusters

    monkeypatch.setattr(clusters, "RECONNECT_S", 0.5)
    port = there.free_port()
    name = f"dask://127.0.0.1:{port}"
    with pytest.raises(CalibrationError, match=f"{name}: no Dask scheduler answers within 0.5 s"):
        executor_of(name)
    monkeypatch.setattr(clusters, "RECONNECT_S", 20.0)
    with there.Cluster(port) as cluster:
        cluster.start(0)
        with pytest.raises(CalibrationError, match="has no workers; start some with 'dask worker"):
            executor_of(name)


def test_worker_that_does_not_see_the_directory_or_has_other_code_is_refused(
    tmp_path: Path, monkeypatch
):
    from calibrate.runs.executors import remote

    (spec,) = specs(1)
    expected = remote.expected_case((spec, tmp_path))
    with pytest.raises(CaseError, match=r"does not see this directory.*all workers share"):
        remote.run_there(expected, there.execute, spec, tmp_path / "elsewhere")
    monkeypatch.setattr(remote, "case_id", lambda _spec: "another")
    with pytest.raises(CaseError, match="another version of bulkcal or of the engine"):
        remote.run_there(expected, there.execute, spec, tmp_path)
    assert there.starts(tmp_path) == []
    assert remote.run_there(remote.expected_case(("7",)), int, "7") == 7


def test_nothing_is_started_for_a_campaign_that_has_all_its_results(tmp_path: Path):
    for spec in specs(1, 2):
        there.execute(spec, tmp_path)
    threads = threading.active_count()
    began = time.monotonic()
    with executor_of("dask-local", 2) as executor, campaign(tmp_path, executor) as runs:
        assert runs(specs(1, 2), "stored")["status"].tolist() == ["ok", "ok"]
    assert time.monotonic() - began < 1.0  # a cluster takes more than that to start
    assert threading.active_count() == threads
