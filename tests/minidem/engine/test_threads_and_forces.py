"""Forces before walls, changing diameters and images of meshes with two threads."""

from __future__ import annotations

import pytest

from minidem import run_script
from tests.minidem.engine import cases as engine_cases
from tests.minidem.engine.case_list import CASES
from tests.minidem.engine.test_cases import STORED, compare


@pytest.mark.parametrize(
    "name",
    [
        "setforce with variables before and after a wall", "adapt: diameters that grow",
        "setforce before a wall spares the wall force", "periodic: two motions, several runs",
    ],
)  # fmt: skip
def test_two_threads_give_the_stored_numbers(tmp_path, name):
    case = CASES[name]
    run_script(case.write(tmp_path), root=tmp_path, threads=2)
    compare(engine_cases.read(tmp_path), STORED[name], case.rtol)
