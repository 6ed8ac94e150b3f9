"""Clear photographs, those of the tutorial: what is made for hard light leaves them alone."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from liggghts_io.photo.grains.sizes import measure_sizes
from liggghts_io.photo.heap import measure_heap
from liggghts_io.photo.reading import read_photo
from tests.paths import ROOT

TILT_DEG = -0.8
"""Of the camera, as `docs/laboratory/visit.py` draws it."""


@pytest.fixture(scope="module")
def photos(tmp_path_factory) -> Path:
    """Return the folder of the photographs."""
    beads = tmp_path_factory.mktemp("laboratory") / "beads"
    visit = ROOT / "docs" / "laboratory" / "visit.py"
    subprocess.run([sys.executable, str(visit), str(beads)], check=True, capture_output=True)
    return beads / "photos"


@pytest.mark.parametrize("name", ["heap_glued3", "heap_steel5"])
def test_the_plate_under_a_heap_is_followed(photos: Path, name: str):
    """What is unlike the wall ends 0.6 and 0.8 degrees off: its edge lies less surely."""
    heap = measure_heap(read_photo(photos / f"{name}.png"))
    assert heap.plate.tilt_deg == pytest.approx(TILT_DEG, abs=0.1)


def test_a_bright_spot_on_one_side_of_every_bead_is_no_shadow(photos: Path):
    """Ellipses through one side of their rims made them 1 % too large, and all of them round."""
    grains = read_photo(photos / "grains.png")[:960]  # above the ruler
    found = measure_sizes(grains, 1e-3 / 20.0)
    assert not found.shadows
    # 320 beads were drawn with a d32 of 1811 um; blur at their rims is worth half a per cent.
    assert found.d32_m == pytest.approx(1811e-6, rel=0.005)
