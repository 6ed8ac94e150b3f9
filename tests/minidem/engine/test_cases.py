"""Rules of LIGGGHTS, one small script each: stored numbers, and the program itself."""

from __future__ import annotations

import numpy as np
import pytest

from minidem import run_script
from tests.minidem.engine import cases as engine_cases
from tests.minidem.engine.case_list import CASES
from tests.minidem.engine.cases import QUANTITIES, STORED_MODELS, STORED_WET, Case, Outcome
from tests.minidem.laws.model_list import MODEL_CASES
from tests.minidem.wet.wet_list import WET_CASES

STORED = {
    name: found
    for path in (engine_cases.STORED, STORED_MODELS, STORED_WET)
    for name, found in engine_cases.load(path).items()
}
ALL = CASES | MODEL_CASES | WET_CASES
ABSOLUTE = 1e-16
"""Rounding noise where a quantity is zero but for cancelled sums."""


def compare(found: Outcome, wanted: Outcome, rtol: float) -> None:
    """Compare particles by id, and thermo lines."""
    for step, rows in wanted.frames.items():
        mine = found.frames[step]
        mine = mine[np.isin(mine[:, 0], rows[:, 0])]
        assert mine.shape == rows.shape, f"step {step}: other particles"
        np.testing.assert_array_equal(mine[:, :2], rows[:, :2], f"step {step}: ids and types")
        for name, columns in QUANTITIES.items():
            size = np.abs(rows[:, columns]).max(initial=0.0)
            error = np.abs(mine[:, columns] - rows[:, columns]).max(initial=0.0)
            assert error <= rtol * size + ABSOLUTE, f"step {step} {name}: {error:.2e} of {size:.2e}"
    assert list(found.thermo) == list(wanted.thermo)
    for step, row in wanted.thermo.items():
        np.testing.assert_allclose(
            found.thermo[step], row, rtol=rtol, atol=ABSOLUTE, err_msg=f"thermo at step {step}"
        )


@pytest.mark.slow
@pytest.mark.parametrize("name", ALL)
def test_case_has_the_stored_numbers(tmp_path, name):
    case: Case = ALL[name]
    run_script(case.write(tmp_path), root=tmp_path)
    compare(engine_cases.read(tmp_path), STORED[name], case.rtol)


@pytest.mark.liggghts
@pytest.mark.parametrize("name", ALL)
def test_stored_numbers_are_those_of_liggghts(tmp_path, name):
    # the same program on the same kind of machine: compilers may differ in the last digits
    compare(engine_cases.run_liggghts(ALL[name], tmp_path), STORED[name], 1e-12)


def test_every_stored_case_is_there():
    assert list(STORED) == list(ALL)
