"""Cones photographed from above: their angle is too small, and their round foot tells by how much.

They are drawn as a camera far away sees them: a point above an ellipse, and the hull of both.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image

from calibrate.cli.laboratory.photo_angle import measured_heaps, tell_doubts
from calibrate.cli.laboratory.photo_size_doubts import size_doubts
from calibrate.cli.show.output import Screen
from liggghts_io.photo.above import seen_from_above
from liggghts_io.photo.grains.result import GrainSizes
from liggghts_io.photo.heap import measure_heap
from tests.liggghts_io.photo.heaps import Pile, photograph

ANGLE, FOOT = 33.0, 300.0  # deg; px, radius of the foot
FINER = 3


def _cone(elevation: float, *, seed: int = 1, turned: float = 0.0) -> np.ndarray:
    """Return a dark cone on a grey plate before a bright wall, seen from above."""
    rng = np.random.default_rng(seed)
    middle, row, sine = 450.0, 420.0, np.sin(np.radians(elevation))
    light = np.full((600 * FINER, 900 * FINER, 3), (205, 203, 196), np.uint8)
    horizon = row - 60.0 if elevation else row  # the plate's far edge, behind the heap
    light[round(horizon * FINER) :] = (150, 150, 155)
    turn = np.linspace(0.0, 2.0 * np.pi, 400)
    foot = np.stack([middle + FOOT * np.cos(turn), row + FOOT * sine * np.sin(turn)], axis=-1)
    high = FOOT * np.tan(np.radians(ANGLE)) * np.cos(np.radians(elevation))
    if not elevation:
        foot = foot[foot[:, 1] <= row + 1e-9]
    outline = cv2.convexHull(np.vstack([foot, [middle, row - high]]).astype(np.float32))
    cv2.fillPoly(light, [np.round(outline * FINER).astype(np.int32)], (80, 72, 64))
    small = cv2.GaussianBlur(cv2.resize(light, (900, 600), interpolation=cv2.INTER_AREA), (0, 0), 1)
    about = cv2.getRotationMatrix2D((450.0, 300.0), turned, 1.0)
    small = cv2.warpAffine(small, about, (900, 600), borderMode=cv2.BORDER_REPLICATE)
    return np.clip(small + rng.normal(0, 3, small.shape), 0, 255).astype(np.uint8)


@pytest.mark.parametrize("turned", [0.0, 2.0])
@pytest.mark.parametrize("elevation", [12.0, 18.0])
def test_the_foot_tells_from_how_far_above(elevation: float, turned: float):
    """Within 2 deg, of which one is the step of what is tried; then the true angle is known."""
    picture = _cone(elevation, turned=turned)
    heap = measure_heap(picture)
    above = seen_from_above(picture, heap.lines, heap.plate.slope)
    assert above is not None
    assert above.elevation_deg == pytest.approx(elevation, abs=2.0)
    assert heap.repose.angle_deg < ANGLE - 1.0
    assert heap.repose.angle_deg + above.flatter_deg == pytest.approx(ANGLE, abs=1.5)


LEVEL = {
    "the same cone": _cone(0.0),
    "grains": photograph(Pile(grains=5.0)),
    "tilted": photograph(Pile(tilt=4.0)),
    "tray": photograph(Pile(plate_width=760.0, plate_thickness=25.0)),
    "plate as dark as the heap": photograph(Pile(table=(75, 66, 60))),
    "shadow": photograph(Pile(shadow=0.45, reach=1.3)),
    "no plate to be seen": photograph(Pile(plate=0.0)),
    "spilled": photograph(Pile(spilled=40)),
}


@pytest.mark.parametrize("name", LEVEL)
def test_level_cameras_are_not_blamed(name: str):
    heap = measure_heap(LEVEL[name])
    above = seen_from_above(LEVEL[name], heap.lines, heap.plate.slope)
    assert above is None or above.flatter_deg < 0.5


def test_one_flank_alone_tells_nothing():
    picture = photograph(Pile())[:, :500]
    heap = measure_heap(picture)
    assert seen_from_above(picture, heap.lines, heap.plate.slope) is None


def test_a_photo_from_above_gets_a_word(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    """29.0 deg of a heap of 33 stood there with an error of 0.1 and without a word."""
    for name, elevation in (("above.png", 16.0), ("level.png", 0.0)):
        Image.fromarray(_cone(elevation)).save(tmp_path / name)
    photos = [tmp_path / "above.png", tmp_path / "level.png"]
    tell_doubts(Screen(), measured_heaps(photos, "", "", draw=False))
    said = " ".join(capsys.readouterr().err.split())
    assert "deg above, which makes its angle too small by up to" in said
    assert "level.png" not in said


def test_a_rough_outline_gets_a_word(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    """A heap of 7 grains in height; where a wall's pattern gets into an outline it looks alike."""
    small = Pile(size=(600, 300), height=130.0, plate=50.0)
    for name, grains in (("rough.png", 18.0), ("fine.png", 3.0)):
        Image.fromarray(photograph(replace(small, grains=grains))).save(tmp_path / name)
    photos = [tmp_path / "rough.png", tmp_path / "fine.png"]
    tell_doubts(Screen(), measured_heaps(photos, "", "", draw=False))
    said = " ".join(capsys.readouterr().err.split())
    assert "its outline scatters by" in said
    assert "fine.png" not in said


def test_a_camera_that_looked_obliquely_is_told():
    """Grains look a tenth larger at one side than opposite; by chance they do so by 2 %."""
    rng = np.random.default_rng(5)
    places = rng.uniform(0.0, 1000.0, (200, 1, 2))
    sizes = np.exp(0.1 * rng.standard_normal(200))
    outlines = places + np.zeros((1, 4, 1))
    even = GrainSizes(sizes, sizes, outlines, outlines[:0], (), 0, "dark", 1.0)
    grown = replace(even, diameters_m=sizes * (1.0 + 1e-4 * places[:, 0, 1]))
    assert even.growth() == 0.0
    assert grown.growth() == pytest.approx(0.1, abs=0.03)
    assert any("obliquely" in one for one in size_doubts([grown], grown, {}))
