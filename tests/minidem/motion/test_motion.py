"""Words of motion, each in a small script: stored numbers of LIGGGHTS, and the program itself."""

from __future__ import annotations

import pytest

from minidem import run_script
from tests.minidem.engine import cases as engine_cases
from tests.minidem.engine.test_cases import compare
from tests.minidem.motion.stored import LISTS, cases, stored

OUTCOMES = {name: engine_cases.load(stored(name)) for name in LISTS}
EVERY = [(one, name) for one in LISTS for name in cases(one)]


@pytest.mark.parametrize(("one", "name"), EVERY, ids=lambda word: word)
def test_case_has_the_stored_numbers(tmp_path, one, name):
    case = cases(one)[name]
    run_script(case.write(tmp_path), root=tmp_path)
    compare(engine_cases.read(tmp_path), OUTCOMES[one][name], case.rtol)


@pytest.mark.liggghts
@pytest.mark.parametrize(("one", "name"), EVERY, ids=lambda word: word)
def test_stored_numbers_are_those_of_liggghts(tmp_path, one, name):
    # the same program on the same kind of machine: compilers may differ in the last digits
    found = engine_cases.run_liggghts(cases(one)[name], tmp_path)
    compare(found, OUTCOMES[one][name], 1e-12)


@pytest.mark.parametrize("one", LISTS)
def test_every_stored_case_is_there(one):
    assert list(OUTCOMES[one]) == list(cases(one))
