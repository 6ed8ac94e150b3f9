"""Order of lines in dumps, ids after `delete_atoms`, and chance, as LIGGGHTS 3.8.0 has them."""

from __future__ import annotations

import json

import pytest

from minidem import run_script
from minidem.errors import ScriptError
from tests.minidem.order.orders import CASES, STORED, liggghts, snapshots

WANTED = json.loads(STORED.read_text())

RTOL = 1e-10
"""Of sums of places, which are off by 1e-15; other processors round otherwise, and collisions let
that grow."""


@pytest.mark.parametrize("name", CASES)
def test_particles_are_held_in_the_order_of_liggghts(name):
    found = snapshots(CASES[name], lambda script: run_script(script, root=script.parent))
    wanted = WANTED[name]
    assert list(found) == list(wanted)
    for step, (ids, sums) in wanted.items():
        assert found[step][0] == ids, f"step {step}"
        assert found[step][1] == pytest.approx(sums, rel=RTOL), f"step {step}"


def test_the_cases_tell_order_from_no_order():
    # in the order of creation ids would rise; contacts would matter less without grains that touch
    for name, steps in WANTED.items():
        ids, _ = list(steps.values())[-1]
        assert len(ids) > 20, name
        # without sorting `delete_atoms` counts them anew in their order
        assert ids != sorted(ids) or "not sorted" in name, name


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("sort 100 -1", "SIZE -1 is negative"),
        ("sort 100 1e-300", "Too many atom sorting"),
    ],
)
def test_where_liggghts_cannot_sort_no_run_begins(tmp_path, words, message):
    script = tmp_path / "in.order"
    script.write_text(CASES["as usual"].replace("map array", f"map array {words}"))
    with pytest.raises(ScriptError, match=message):
        run_script(script, root=tmp_path)


def test_a_run_without_particles_ends_as_in_liggghts(tmp_path):
    lines = [
        line for line in CASES["as usual"].replace("&\n", "").splitlines()
        if not line.startswith(("fix one", "fix two", "fix both", "fix ins"))
    ]  # fmt: skip
    script = tmp_path / "in.order"
    script.write_text("\n".join(lines) + "\n")
    with pytest.raises(ScriptError, match="there are no particles, and no distribution"):
        run_script(script, root=tmp_path)
    script.write_text("\n".join(lines).replace("map array", "map array sort 0 0") + "\n")
    run_script(script, root=tmp_path)


@pytest.mark.liggghts
def test_the_stored_order_is_that_of_liggghts():
    name = "some go"
    found = snapshots(CASES[name], liggghts)
    assert json.loads(json.dumps(found)) == WANTED[name]
