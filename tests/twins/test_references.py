"""Thousands of random cases of every kernel with branches by geometry, against LIGGGHTS 3.8.0.

minidem is compared with stored results of LIGGGHTS, and these, where it is installed, with the
program itself. `tests.twins.references.campaign` says how they are made and runs more of them.
"""

from __future__ import annotations

from functools import cache

import pytest

from tests.twins.references.batch import Batch, run
from tests.twins.references.campaign import FAMILIES, apart, last_frames, stored

ALL = [(name, seed) for name, family in FAMILIES.items() for seed in family.seeds]


@cache
def made(name: str, seed: int) -> Batch:
    """Return a batch; making one takes half a second."""
    return FAMILIES[name].make(seed)


@pytest.mark.parametrize(("name", "seed"), ALL)
def test_minidem_gives_what_liggghts_gave(name: str, seed: int):
    batch = made(name, seed)
    worst = apart(FAMILIES[name], last_frames(run(batch, "minidem")), stored(name, batch))
    assert not worst


@pytest.mark.liggghts
@pytest.mark.parametrize(("name", "seed"), ALL)
def test_liggghts_still_gives_the_stored_results(name: str, seed: int):
    batch = made(name, seed)
    worst = apart(FAMILIES[name], last_frames(run(batch, "liggghts")), stored(name, batch))
    assert not worst


def test_there_are_two_thousand_spheres_on_meshes():
    assert sum(made("meshes", seed).cases for seed in FAMILIES["meshes"].seeds) >= 2000


def test_a_difference_would_be_found():
    name, seed = "walls", 0
    wanted = stored(name, made(name, seed))
    found = {output: table.copy() for output, table in wanted.items()}
    found["out.dump"][3, 8] += 2e-10 * abs(wanted["out.dump"][:, 8:11]).max()
    assert apart(FAMILIES[name], found, wanted)
