"""Grains are counted under their own ids, although the engine re-sorts them as they fall."""

from __future__ import annotations

import pytest

from minidem import run_script
from tests.minidem.engine import cases as engine_cases
from tests.minidem.engine.case_list import MESH, WEIGHT, ball
from tests.minidem.engine.cases import Case, plate

GRAINS = 60


def diameter(number: int) -> float:
    """Return a diameter that belongs to one grain only, to the four digits of the file, m."""
    return round(0.004 + 2e-5 * number, 8)


def falling(more: str = "") -> Case:
    """Return grains on a lattice, numbered against the order in which the engine sorts them."""
    grains = ""
    for k in range(GRAINS):
        x, y, z = 4 - k % 5, 2 - k // 5 % 3, 3 - k // 15
        place = f"{0.012 * x - 0.03} {0.012 * y - 0.01} {0.03 + 0.01 * z}"
        grains += ball(k + 1, place, f"0.3 {0.1 * (k % 3)} -{1 + 0.05 * (k * 7 % 11)}",
                       diameter=diameter(k + 1))  # fmt: skip
    counter = (
        f"fix f all massflow/mesh mesh cad count once vec_side 0 0 -1 file flow.txt writeTime{more}"
    )
    return Case(
        WEIGHT + grains + MESH + counter, steps=6000, skin=0.001, thermo="atoms f_f[1] f_f[2]",
        meshes={"m.stl": plate(0.01, 0.09, 4)},
    )  # fmt: skip


@pytest.mark.parametrize("more", ["", " delete_atoms yes"], ids=["stay", "deleted"])
def test_rows_of_the_file_belong_to_their_ids(tmp_path, more):
    summary = run_script(falling(more).write(tmp_path), root=tmp_path)
    assert summary.builds > 50  # many re-sortings between the passages
    rows = [line.split() for line in (tmp_path / "flow.txt").read_text().splitlines()[1:]]
    assert sorted(int(row[0]) for row in rows) == list(range(1, GRAINS + 1))
    for row in rows:
        assert float(row[2]) == pytest.approx(diameter(int(row[0])), rel=1e-3), row
    assert summary.particles == (0 if more else GRAINS)


@pytest.mark.liggghts
@pytest.mark.parametrize("more", ["", " delete_atoms yes"], ids=["stay", "deleted"])
def test_file_is_that_of_liggghts(tmp_path, more):
    case = falling(more)
    run_script(case.write(tmp_path / "minidem"), root=tmp_path / "minidem")
    engine_cases.run_liggghts(case, tmp_path / "liggghts")
    mine, theirs = (
        sorted((tmp_path / name / "flow.txt").read_text().splitlines(), key=str)
        for name in ("minidem", "liggghts")
    )
    # passages of one step are written in the order of each program's lists
    assert mine == theirs


def test_a_property_is_summed_of_grains_that_have_left_the_box(tmp_path):
    """They pass just above the floor of the box, and are gone when the counter is asked."""
    lines = (
        "fix warm all property/atom warmth scalar no no no 2.5\n"
        + WEIGHT
        + ball(1, "0 0 -0.09", "0 0 -1", diameter=0.004)
        + ball(2, "0.02 0 -0.07", "0 0 -1", diameter=0.004)
        + "set atom 2 property/atom warmth 4.0\n"
        + MESH
        + "fix f all massflow/mesh mesh cad count once vec_side 0 0 -1 sum_property warmth"
    )
    case = Case(
        lines, steps=6000, thermo="atoms f_f[2] f_f[7]",
        meshes={"m.stl": plate(-0.0995, 0.09, 4)},
    )  # fmt: skip
    summary = run_script(case.write(tmp_path), root=tmp_path)
    assert summary.particles == 0
    last = [line.split() for line in (tmp_path / "log.liggghts").read_text().splitlines()]
    assert next(row[-2:] for row in last if row[:2] == ["6000", "0"]) == ["2", "6.5"]
