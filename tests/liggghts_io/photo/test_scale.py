"""The scale of a photograph: words, points, rulers."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from liggghts_io import CaseError
from liggghts_io.photo.colour import grey_of
from liggghts_io.photo.grains.sizes import measure_sizes
from liggghts_io.photo.ruler import check_ruler, find_ruler
from liggghts_io.photo.scale import length_of, points_of, scale_between, scale_of
from tests.liggghts_io.photo.scene import Scene, grains_in_rows, photograph

TICK = 1.5e-3
"""A tick is found to this part: a picture's width to a pixel."""


@pytest.mark.parametrize(
    ("text", "metres"),
    [
        ("22.7px/mm", 1e-3 / 22.7),
        ("22,7 px / mm", 1e-3 / 22.7),
        ("227px/cm", 1e-2 / 227),
        ("0.02pixel/um", 5e-5),
        ("44um/px", 44e-6),
        ("44µm/px", 44e-6),
        ("0.044mm/px", 44e-6),
        ("600px/in", 0.0254 / 600),
    ],
)
def test_scales_in_words(text: str, metres: float):
    assert scale_of(text) == pytest.approx(metres)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("22.7", "write it as 22.7px/mm"),
        ("", "is no scale"),
        ("nanpx/mm", "is no scale"),
        ("px/mm", "is no scale"),
        ("22.7px/kg", "unknown unit of length 'kg'"),
        ("22.7mm/mm", "counts no pixels"),
        ("0px/mm", "above 0"),
        ("-3px/mm", "above 0"),
        ("1e99px/mm", "check number and unit"),
        ("22.7px/m", "check number and unit"),
    ],
)
def test_what_is_no_scale_is_refused(text: str, said: str):
    with pytest.raises(CaseError, match=f"--scale.*{said}"):
        scale_of(text)


def test_two_points():
    assert scale_between("100,50,400,450,10mm") == pytest.approx(10e-3 / 500)
    assert scale_between("100, 50, 400, 450, 1 cm") == pytest.approx(10e-3 / 500)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("1,2,3", "has 3 parts"),
        ("1,2,1,2,5mm", "both points are one"),
        ("1,2,x,2,5mm", "no two points"),
        ("1,2,101,2,5kg", "unknown unit"),
        ("1,2,101,2,0mm", "above 0"),
        ("1,2,101,2,mm", "no length"),
        ("1,2,101,2,10", "'10' is no length with a unit; write it as 10mm"),
    ],
)
def test_what_are_no_points_is_refused(text: str, said: str):
    with pytest.raises(CaseError, match=f"--points.*{said}"):
        scale_between(text)


def test_lengths_and_points_of_other_options():
    assert length_of("0.5mm", "--ruler") == pytest.approx(5e-4)
    with pytest.raises(CaseError, match="--ruler: '1' is no length with a unit"):
        length_of("1", "--ruler")
    assert points_of("1,2,3.5,-4", "--level") == (1.0, 2.0, 3.5, -4.0)


def _turned(grey: np.ndarray, degrees: float) -> np.ndarray:
    rows, columns = grey.shape
    about = cv2.getRotationMatrix2D((columns / 2, rows / 2), degrees, 1.0)
    c, s = abs(about[0, 0]), abs(about[0, 1])
    size = (round(rows * s + columns * c), round(rows * c + columns * s))
    about[:, 2] += [0.5 * (size[0] - columns), 0.5 * (size[1] - rows)]
    return cv2.warpAffine(grey, about, size, borderMode=cv2.BORDER_REPLICATE)


@pytest.mark.parametrize("degrees", [0.0, 2.5, -6.0, 90.0, 87.0])
@pytest.mark.parametrize(("diameter", "count"), [(30.0, 60), (12.0, 150)])
def test_a_ruler_however_it_lies(degrees: float, diameter: float, count: int):
    """The drawn ruler has a tick each diameter, in whole pixels, beside grains of that size."""
    grey, _ = photograph(Scene(diameter=diameter, count=count, ruler=True))
    picture = _turned(grey, degrees)
    found = find_ruler(grey_of(np.repeat(picture[:, :, None], 3, axis=2)))
    assert found.pixels == pytest.approx(diameter, rel=TICK)


@pytest.mark.parametrize("degrees", [-20.0, 52.0])
def test_a_ruler_that_lies_askew(degrees: float):
    """A level line across its long ticks repeats itself, too, but farther apart."""
    grey, _ = photograph(Scene(diameter=16.0, count=60, ruler=True))
    picture = _turned(grey, degrees)
    found = find_ruler(grey_of(np.repeat(picture[:, :, None], 3, axis=2)))
    assert found.pixels == pytest.approx(16.0, rel=TICK)


def test_grains_in_rows_are_no_ruler():
    picture = grains_in_rows()
    found = find_ruler(grey_of(picture))
    with pytest.raises(CaseError, match="52 px are grains in a row"):
        check_ruler(found, measure_sizes(picture, 1.0).outlines)


@pytest.mark.parametrize("scene", [Scene(count=60), Scene(diameter=8.0, count=300, cover=0.25)])
def test_grains_alone_are_no_ruler(scene: Scene):
    grey, _ = photograph(scene)
    with pytest.raises(CaseError, match="no ruler in the picture"):
        find_ruler(grey.astype(np.float32))
