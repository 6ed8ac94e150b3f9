"""A time-out is data: told, stored, not tried again before more time is allowed."""

from __future__ import annotations

import dataclasses
from pathlib import Path

from calibrate.runs.campaign import Campaign
from calibrate.runs.executors.run_options import RunOptions
from calibrate.runs.retry import set_aside
from calibrate.runs.stored import stored_case
from liggghts_io import execute
from tests.calibrate.runs.test_campaign import specs

SMALL = {"pour_grains": 60, "pour_tau": 12, "settle_tau": 6, "pour_stages": 2}


def run(root: Path, limit_s: float | None) -> tuple[dict, list[str]]:
    """Run one small heap in a campaign of its own; return its row and what was told."""
    told: list[str] = []
    how = RunOptions(limit_s=limit_s)
    spec = dataclasses.replace(specs(3)[0], apparatus=SMALL)
    with Campaign(
        root, how.limited(execute), stored=how.limited(stored_case), workers=1, tell=told.append
    ) as campaign:
        (row,) = campaign([spec], "late").to_dict("records")
    return row, told


def test_time_out_is_told_and_stands_until_more_time_is_allowed(tmp_path: Path):
    row, told = run(tmp_path, 0.001)
    assert (row["status"], row["failure"]) == ("failed", "time")
    assert row["reason"] == "minidem was stopped after 0.001 s, the limit of a run"
    assert told[0] == "1 of 1 runs failed: 1 time"  # and not that it is tried again
    assert told[-1] == "  what ran out of time runs again with a longer --time-limit"
    result = tmp_path / row["case_id"] / "result.json"
    before = result.stat().st_mtime_ns
    assert run(tmp_path, 0.001)[0] == row
    assert result.stat().st_mtime_ns == before
    row, _ = run(tmp_path, None)
    assert row["failure"] != "time"


def test_retry_sets_a_time_out_aside(tmp_path: Path):
    row, _ = run(tmp_path, 0.001)
    assert set_aside(tmp_path, "time") == [tmp_path / row["case_id"]]
    assert RunOptions(limit_s=0.001).limited(stored_case)(
        dataclasses.replace(specs(3)[0], apparatus=SMALL), tmp_path
    ) is None  # fmt: skip
