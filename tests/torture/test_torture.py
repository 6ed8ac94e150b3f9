"""Campaigns in trouble, in small; benchmarks/torture.py does the same some hundred times."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from tests.torture.damage import HARMS
from tests.torture.disk import mountable
from tests.torture.rounds import Torture, accident_round, damage_round, disk_round, undisturbed

pytestmark = pytest.mark.skipif(
    not Path("/proc/self/environ").exists(), reason="finds processes by /proc"
)
CASES = 4
ACCIDENTS = {
    "kill -9 of the campaign": 1,
    "kill -9 of a worker": 2,
    "SIGINT or SIGTERM": 1,
    "SIGSTOP, then SIGCONT": 1,
    "two campaigns at once": 1,
}


@pytest.fixture
def draw(request: pytest.FixtureRequest) -> random.Random:
    """Return a random generator; `--seed` varies it."""
    return random.Random(request.config.getoption("--seed"))


@pytest.fixture(scope="module")
def torture(tmp_path_factory: pytest.TempPathFactory) -> Torture:
    return undisturbed(tmp_path_factory.mktemp("torture"), "minidem", CASES)


@pytest.mark.parametrize("name", ACCIDENTS)
def test_campaign_survives(name: str, torture: Torture, draw: random.Random):
    verdict = accident_round(torture, name, ACCIDENTS[name], draw)
    assert verdict.faults == []
    assert verdict.incidents > 0


def test_stored_files_are_harmed(torture: Torture, draw: random.Random):
    verdict = damage_round(torture, [*HARMS, "littered"], draw)
    assert verdict.faults == []
    assert verdict.incidents >= CASES


@pytest.mark.skipif(not mountable(), reason="only root may mount a small disk")
def test_disk_fills_and_is_freed(torture: Torture, draw: random.Random):
    verdict = disk_round(torture, 1, draw)
    assert verdict.faults == []
    assert verdict.incidents == 1


@pytest.mark.liggghts
def test_liggghts_is_killed(tmp_path: Path, draw: random.Random):
    torture = undisturbed(tmp_path, "liggghts", CASES)
    verdict = accident_round(torture, "kill -9 of LIGGGHTS", 1, draw)
    assert verdict.faults == []
