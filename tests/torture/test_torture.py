"""Campaigns in trouble, in small; benchmarks/torture.py does the same some hundred times."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from tests.torture.arena import hear_ctrl_c
from tests.torture.damage import HARMS
from tests.torture.disk import mountable
from tests.torture.rounds import Torture, accident_round, damage_round, disk_round, undisturbed

pytestmark = pytest.mark.skipif(
    not Path("/proc/self/environ").exists(), reason="finds processes by /proc"
)
CASES, FEW = 6, 3
ONE_BY_ONE = ("kill -9 of the campaign", "SIGINT or SIGTERM", "kill -9 of a worker")
"""What leaves work for the next of them."""


@pytest.fixture
def draw(request: pytest.FixtureRequest) -> random.Random:
    """Return a random generator; `--seed` varies it."""
    return random.Random(request.config.getoption("--seed"))


@pytest.fixture(scope="module")
def torture(tmp_path_factory: pytest.TempPathFactory) -> Torture:
    hear_ctrl_c()
    return undisturbed(tmp_path_factory.mktemp("torture"), "minidem", CASES)


def test_campaign_is_killed_interrupted_and_loses_a_worker(torture, draw: random.Random):
    verdict = accident_round(torture, ONE_BY_ONE, 1, draw)
    assert verdict.faults == [], "\n".join(verdict.faults)
    assert verdict.incidents > 1


@pytest.mark.parametrize("name", ["SIGSTOP, then SIGCONT", "two campaigns at once"])
def test_campaign_survives(name: str, torture: Torture, draw: random.Random):
    verdict = accident_round(torture, [name], 1, draw)
    assert verdict.faults == [], "\n".join(verdict.faults)
    assert verdict.incidents == 1


def test_stored_files_are_harmed(torture: Torture, draw: random.Random):
    verdict = damage_round(torture, [*HARMS, "littered"], draw)
    assert verdict.faults == [], "\n".join(verdict.faults)
    assert verdict.incidents >= CASES


@pytest.mark.skipif(not mountable(), reason="only root may mount a small disk")
def test_disk_fills_and_is_freed(torture: Torture, draw: random.Random):
    verdict = disk_round(torture, 1, draw)
    assert verdict.faults == [], "\n".join(verdict.faults)
    assert verdict.incidents == 1


@pytest.mark.liggghts
def test_liggghts_is_killed(tmp_path: Path, draw: random.Random):
    torture = undisturbed(tmp_path, "liggghts", FEW)
    verdict = accident_round(torture, ["kill -9 of LIGGGHTS", "SIGINT or SIGTERM"], 1, draw)
    assert verdict.faults == [], "\n".join(verdict.faults)
