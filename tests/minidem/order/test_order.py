"""Order of lines in dumps, ids after `delete_atoms`, and chance, as LIGGGHTS 3.8.0 has them."""

from __future__ import annotations

import json

import pytest

from minidem import run_script
from tests.minidem.order.orders import CASES, STORED, liggghts, snapshots

WANTED = json.loads(STORED.read_text())

RTOL = 1e-10
"""Of sums of places: collisions of some hundred grains let rounding grow to 1e-12."""


@pytest.mark.filterwarnings("ignore::UserWarning")
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
        assert ids != sorted(ids), name


@pytest.mark.liggghts
def test_the_stored_order_is_that_of_liggghts():
    name = "some go"
    found = snapshots(CASES[name], liggghts)
    assert json.loads(json.dumps(found)) == WANTED[name]
