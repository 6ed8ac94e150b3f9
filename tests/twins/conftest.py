"""Twins of the engine are compared with the loops that are compiled for their models."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.minidem.loops import own_loops


@pytest.fixture(autouse=True, scope="module")
def _own_loops() -> Iterator[None]:
    with own_loops():
        yield
