"""Forces before walls, changing diameters and images of meshes with two threads.

Interpreted: the pieces of both threads are worked on, one after the other. That the result does not
depend on who does the work, and that compiled threads do it, is what `test_threads` says.
"""

from __future__ import annotations

import pytest

from tests.minidem.engine import cases as engine_cases
from tests.minidem.engine.case_list import CASES
from tests.minidem.engine.test_cases import STORED, compare
from tests.minidem.interpreted import run_interpreted


@pytest.mark.parametrize(
    "name",
    [
        "setforce with variables before and after a wall", "adapt: diameters that grow",
        "setforce before a wall spares the wall force", "periodic: two motions, several runs",
    ],
)  # fmt: skip
def test_two_threads_give_the_stored_numbers(tmp_path, name):
    case = CASES[name]
    run_interpreted(case.write(tmp_path), threads=2)
    compare(engine_cases.read(tmp_path), STORED[name], case.rtol)
