"""Planted sets for joint fits share what they say they share."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.peers.apparatus import RANGES, TARGETS
from benchmarks.peers.joint_fits.fits import fit_all
from benchmarks.peers.joint_fits.planted import KINDS, SETS, instances, plant_set, true_values
from benchmarks.peers.joint_fits.table import STORED, load_fits, summary
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


@pytest.mark.long
def test_a_joint_fit_covers_and_narrows_what_is_shared(tmp_path: Path) -> None:
    fit_all(tmp_path, Formula(), 1, 160, tell=lambda _: None)
    table = load_fits(tmp_path)
    assert len(table) == 2 * len(instances(KINDS[ONE_WALL]))
    # 18 intervals of 90 %: fewer than 13 happen once in a hundred times.
    assert table["covered"].sum() >= 13
    shared = table[table["shared"]]
    assert set(shared["parameter"]) == set(RANGES)
    assert shared["narrowed"].median() < 0.95
    rows = summary(table).set_index(["kind", "shared"])
    assert rows["expected"].xs(False, level="shared").to_numpy() == pytest.approx(1.0)
    assert rows["expected"].xs(True, level="shared").max() < 1.0
    simulator = Formula()
    fit_all(tmp_path, simulator, 1, 160, tell=lambda _: None)
    assert simulator.calls == 0


def test_the_stored_fits_hold_together() -> None:
    if not STORED.exists():
        pytest.skip("the joint fits have not been stored yet")
    table = load_fits(None)
    assert not table.duplicated(["kind", "number", "parameter", "owner"]).any()
    assert ((table["sd"] > 0.0) & (table["width"] > table["sd"])).all()
