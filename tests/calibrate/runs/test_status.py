"""`bulkcal status`: what the directories say, whatever the index says, also under way."""

from __future__ import annotations

import json
import os
import threading
import time
from pathlib import Path

import pytest

from calibrate.runs.campaign import Campaign
from calibrate.runs.listing import INDEX, list_cases
from calibrate.runs.presence import CAMPAIGNS, Plan, present
from calibrate.runs.status import status_of
from liggghts_io import Failure
from liggghts_io.case.lock import locked
from tests.calibrate.runs import dask_cluster as there
from tests.calibrate.runs.test_campaign import specs
from tests.calibrate.runs.test_retry import store


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """Store three good runs and failures of two classes; leave some litter beside them."""
    root = tmp_path / "cal" / "runs"
    for seed in (1, 2, 3):
        store(root, seed, "")
    store(root, 4, "physics")
    store(root, 5, "physics")
    store(root, 6, "killed")
    (root / "notes").mkdir()
    (root / "read.me").write_text("mine")
    return root


def counts(root: Path) -> tuple[int, int, int, int]:
    found = status_of(root)
    return found.done, found.failures, found.unfinished, len(found.damaged)


def test_a_directory_without_cases_stays_as_it_is(tmp_path: Path):
    (tmp_path / "notes").mkdir()
    assert list_cases(tmp_path) == []
    assert [path.name for path in tmp_path.iterdir()] == ["notes"]


def test_failures_are_grouped_by_class_and_reason_whatever_the_numbers(root: Path):
    found = status_of(root)
    assert (found.done, found.failures) == (3, 3)
    assert [(one.failure, one.runs) for one in found.failed] == [("physics", 2), ("killed", 1)]
    assert found.failed[0].reason == "because of physics"
    assert (found.running, found.campaigns, found.left_s) == ((), (), None)


def test_reasons_that_differ_in_numbers_only_are_one_group(tmp_path: Path):
    from liggghts_io import CaseResult
    from liggghts_io.case.results import store_result

    for step in (12, 7000):
        reason = f"step {step}: particle {step + 1} is lost at 1.5e-3"
        path = tmp_path / f"{step}"
        path.mkdir()
        store_result(CaseResult("x", path, "failed", reason, {}, 1.0, Failure.PHYSICS))
    (group,) = status_of(tmp_path).failed
    assert (group.runs, group.first) == (2, "12")
    assert group.reason == "step 12: particle 13 is lost at 1.5e-3"


def test_index_is_never_trusted_over_the_directories(root: Path):
    assert counts(root) == (3, 3, 0, 0)
    index = root / INDEX
    good = index.read_text()
    one, two, three, *_ = sorted(root.glob("*/result.json"))
    kept = one.read_text()
    times = (one.stat().st_atime_ns, one.stat().st_mtime_ns)
    # The same length, the same time of last change, another content.
    one.write_text(kept.replace('"wall_s": 1.0', '"wall_s": 2.0'))
    os.utime(one, ns=times)
    assert one.stat().st_size == len(kept)
    assert [case.name for case in status_of(root).damaged] == [one.parent.name]
    one.write_text(kept)
    two.unlink()
    three.write_text(three.read_text()[:40])
    done, failed, unfinished, damaged = counts(root)
    assert (done + failed, unfinished, damaged) == (4, 1, 1)
    # An index of another time, whole and rightly signed, changes nothing.
    index.write_text(good)
    assert counts(root) == (done, failed, unfinished, damaged)


@pytest.mark.parametrize("damage", ["cut", "empty", "lies", "binary", "gone", "old"])
def test_damaged_index_is_rebuilt(root: Path, damage: str):
    before = list_cases(root)
    index = root / INDEX
    text = index.read_text()
    harmed = {
        "cut": text[: len(text) // 2], "empty": "", "lies": text.replace("physics", "killed!"),
        "binary": "\0\1", "old": text.replace("status 1", "status 0"),
    }  # fmt: skip
    index.write_text(harmed.get(damage, ""))
    if damage == "gone":
        index.unlink()
    assert list_cases(root) == before
    assert index.read_text() == text


def test_half_written_and_running_cases_are_told_apart(root: Path):
    half = root / "0123"  # a process died before it had written the record
    half.mkdir()
    (half / "lock").touch()
    (half / "lock.holder").write_text("{")
    died = store(root, 8, "")
    (died / "result.json").unlink()
    (died / "attempt-77").mkdir()
    with locked(root / "4567"):
        found = status_of(root)
    assert found.unfinished == 2
    (running,) = found.running
    assert running.name == "4567"
    assert f"pid {os.getpid()}" in running.reason
    # A finished case that somebody runs again is running.
    with locked(root / sorted(p.parent.name for p in root.glob("*/result.json"))[0]):
        assert len(status_of(root).running) == 1


def test_campaign_under_way_says_what_is_to_come(tmp_path: Path):
    seen: list[tuple] = []

    def look() -> None:
        there.wait_until(lambda: len(list(tmp_path.glob("*/result.json"))) >= 3)
        time.sleep(0.05)
        found = status_of(tmp_path)
        seen.append((found.campaigns, found.waiting, found.per_hour, found.left_s))

    watcher = threading.Thread(target=look)
    watcher.start()
    with Campaign(tmp_path, there.execute, workers=2) as campaign:
        campaign(specs(*range(1, 13)), "stage 1")
    watcher.join()
    ((plan,), waiting, per_hour, left_s) = seen[0]
    assert (plan.label, plan.total, plan.workers) == ("stage 1", 12, 2)
    assert f"pid {os.getpid()}" in plan.who
    assert 4 <= waiting <= 10
    assert per_hour > 100.0
    assert 0.0 < left_s < 600.0
    assert not (tmp_path / CAMPAIGNS).exists()
    assert status_of(tmp_path).done == 12


def test_entry_of_a_dead_campaign_counts_for_nothing_and_is_removed(tmp_path: Path):
    plan = Plan("stage 1", 10, 0, 0, 0, 2, time.time())
    dead = tmp_path / CAMPAIGNS / "dead"
    dead.mkdir(parents=True)
    (dead / "plan.json").write_text(json.dumps({**plan.__dict__}))
    assert status_of(tmp_path).campaigns == ()
    with present(tmp_path, plan):
        assert not dead.exists()
        (alive,) = status_of(tmp_path).campaigns
        assert alive.label == "stage 1"
    assert not (tmp_path / CAMPAIGNS).exists()


def test_command_prints_it_and_as_json(root: Path, bulkcal):
    code, out, _ = bulkcal("status", str(root.parent))
    assert code == 0
    assert f"{root}: 3 done, 3 failed" in out
    assert "failed, physics: because of physics (2 runs like this, first " in out
    assert "no campaign is at work here" in out
    assert f"next: bulkcal retry {root.parent}, to let failed runs run again" in out
    code, out, _ = bulkcal("status", str(root), "--json")
    facts = json.loads(out)
    assert (facts["done"], facts["failed"], facts["left_s"]) == (3, 3, None)
    assert facts["failures"][0]["runs"] == 2


def test_command_refuses_what_holds_no_runs(root: Path, bulkcal, tmp_path: Path):
    assert bulkcal("status", str(tmp_path / "nowhere"))[0] == 2
    case = next(root.glob("*/case.json")).parent
    code, _, err = bulkcal("status", str(case))
    assert code == 2
    assert "is a single case" in err
