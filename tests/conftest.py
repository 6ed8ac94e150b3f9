"""Fixtures and markers shared by all tests."""

from __future__ import annotations

import os
import shutil

# Small matrices gain nothing from threads, which fight for the cores of a small machine.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
# Runs of some seconds would have loops compiled for half a minute each that no test waits for;
# those that need a loop of its own ask for it (tests/minidem/loops.py).
os.environ.setdefault("MINIDEM_COMPILE", "never")

import numpy as np
import pytest
from hypothesis import settings

# A test means the same on every machine; --hypothesis-profile=search looks for new examples.
settings.register_profile("same", derandomize=True, database=None, deadline=None)
settings.register_profile("search", max_examples=500)
settings.load_profile("same")

SEED = 20191111


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--seed", type=int, default=SEED, help="seed of the rng fixture")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Begin with slow files; skip what needs LIGGGHTS where it is missing, unless required."""
    # Files go to workers in this order: long ones in the end would leave the other worker idle.
    # Copies of the project find the compiled kernels of others, and keep none for them.
    slow = {item.path for item in items if "slow" in item.keywords}
    items.sort(key=lambda item: (item.path not in slow, item.path.name == "test_how_to.py"))
    if shutil.which("liggghts") or os.environ.get("BULKCAL_REQUIRE_LIGGGHTS") == "1":
        return
    skip = pytest.mark.skip(reason="LIGGGHTS is not installed (Debian: apt-get install liggghts)")
    for item in items:
        if "liggghts" in item.keywords:
            item.add_marker(skip)


@pytest.fixture
def rng(request: pytest.FixtureRequest) -> np.random.Generator:
    """Return a random generator with a fixed seed; `--seed` varies it."""
    return np.random.default_rng(request.config.getoption("--seed"))
