"""Planted sets for joint fits share what they say they share."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.peers.apparatus import RANGES, TARGETS
from benchmarks.peers.joint_fits.planted import (
    KINDS,
    PLANTED,
    SETS,
    instances,
    plant_all,
    plant_set,
    true_values,
)
from benchmarks.peers.lines import read_lines
from tests.benchmarks.formula import Formula

ONE_WALL, TWO_WALLS = KINDS
WALL = {name for name in RANGES if name.endswith("_pw")}


def test_materials_share_the_wall_and_walls_share_the_material() -> None:
    for kind, shared in ((ONE_WALL, WALL), (TWO_WALLS, set(RANGES) - WALL)):
        owners = {name: set(values) for name, values in true_values(kind, 0).items()}
        assert {name for name in RANGES if len(owners[name]) == 1} == shared
        assert len(instances(KINDS[kind])) == 9


@pytest.mark.parametrize("kind", KINDS)
def test_truths_lie_inside_the_ranges(kind: str) -> None:
    for number in range(SETS):
        for name, values in true_values(kind, number).items():
            low, high = RANGES[name]
            assert all(low < value < high for value in values.values())


def test_a_glued_plate_is_measured_once_per_material() -> None:
    targets = plant_set(Formula(), TWO_WALLS, 0, 4)["targets"]
    glued = [t for t in targets if t["wall"] == "glued"]
    flat = [name for name in TARGETS if not name.endswith("glued")]
    assert len(glued) == len(TARGETS) - len(flat)
    assert len(targets) == len(glued) + 2 * len(flat)
    assert len(plant_set(Formula(), ONE_WALL, 0, 4)["targets"]) == 2 * len(TARGETS)


def test_planting_goes_on_where_it_was(tmp_path: Path) -> None:
    plant_all(tmp_path, Formula(), 4, tell=lambda _: None)
    lines = read_lines(tmp_path / PLANTED)
    assert len(lines) == len(KINDS) * SETS
    simulator = Formula()
    plant_all(tmp_path, simulator, 4, tell=lambda _: None)
    assert simulator.calls == 0
