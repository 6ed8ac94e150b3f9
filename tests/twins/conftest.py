"""Twins of the engine are compared with the loop that serves all models: it is compiled once."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.minidem.loops import general_loops


@pytest.fixture(autouse=True, scope="module")
def _general_loops() -> Iterator[None]:
    with general_loops():
        yield
