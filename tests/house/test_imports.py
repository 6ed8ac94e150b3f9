"""What the import rules in pyproject.toml promise, checked once more from the graph itself."""

from __future__ import annotations

import subprocess
import sys

import grimp
import pytest

from tests.paths import ROOT

PACKAGES = ("calibrate", "liggghts_io", "minidem")


@pytest.fixture(scope="module")
def graph() -> grimp.ImportGraph:
    """Return all imports, also late ones and those for types only."""
    return grimp.build_graph(*PACKAGES, cache_dir=None)


def test_no_module_reaches_itself(graph: grimp.ImportGraph):
    loops = [
        " -> ".join(graph.find_shortest_chain(target, module) or ()) + f" -> {target}"
        for module in graph.modules
        for target in graph.find_modules_directly_imported_by(module)
        if graph.find_shortest_chain(target, module)
    ]
    assert not loops


def test_the_picture_of_the_layers_is_current():
    made = subprocess.run(
        [sys.executable, str(ROOT / "docs" / "draw_layers.py"), "--check"],
        capture_output=True, text=True, check=False, cwd=ROOT,
    )  # fmt: skip
    assert made.returncode == 0, made.stderr or "run 'python docs/draw_layers.py'"


@pytest.mark.parametrize(
    ("importer", "imported"), [("minidem.kernels", "minidem.world"), ("liggghts_io", "calibrate")]
)
def test_nothing_reaches_up(graph: grimp.ImportGraph, importer: str, imported: str):
    assert not graph.find_shortest_chains(importer, imported, as_packages=True)
