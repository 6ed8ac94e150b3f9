"""Rulers as shops sell them: longer ticks each fifth and tenth, numbers, faces of all colours."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from liggghts_io import CaseError
from liggghts_io.photo.colour import grey_of
from liggghts_io.photo.grains.on_ruler import face_of, without_ruler
from liggghts_io.photo.grains.sizes import measure_sizes
from liggghts_io.photo.ruler import find_ruler
from liggghts_io.photo.tick_lengths import are_finest
from tests.liggghts_io.photo.rulers import BOTTOM, GRAINS, LEFT, RADIUS, TOP, close_up, photograph

TICK = 1.5e-3
"""A tick is found to this part: a picture's width to a pixel."""


@pytest.mark.parametrize("tick", [10.3, 6.2, 5.6, 17.4])
def test_ticks_that_are_no_whole_pixels_apart(tick: float):
    """Those 10.3 px apart were taken for 10: all sizes 3 % too large."""
    ruler = find_ruler(grey_of(photograph(close_up(tick, (240, 238, 230)))))
    assert ruler.pixels == pytest.approx(tick, rel=TICK)


@pytest.mark.parametrize("tick", [4.8, 6.6])
def test_ticks_too_close_to_be_seen_one_by_one(tick: float):
    """At 2.4 and 3.3 px: ticks of a centimetre were taken for those of a millimetre."""
    ruler = find_ruler(grey_of(photograph(close_up(tick, (240, 238, 230)), shrink=2.0)))
    assert ruler.pixels == pytest.approx(0.5 * tick, rel=0.01)


def test_wide_ticks_stay_wide():
    """Ticks of 30 px without finer ones between them have as many harmonics as finer ones."""
    ruler = find_ruler(grey_of(photograph(close_up(30.0, (240, 238, 230)))))
    assert ruler.pixels == pytest.approx(30.0, rel=3 * TICK)


@pytest.mark.parametrize(
    "face", [(240, 238, 230), (240, 210, 60), (195, 193, 190), (170, 172, 175)]
)
@pytest.mark.parametrize("tick", [10.3, 20.6])
def test_what_lies_on_a_ruler_is_no_grain(face: tuple[int, int, int], tick: float):
    """Numbers were counted, on white, yellow and clear rulers; the grains all stay."""
    picture = photograph(close_up(tick, face))
    ruler = find_ruler(grey_of(picture))
    found = without_ruler(measure_sizes(picture, 1.0), picture, ruler)
    assert found.count == GRAINS
    assert found.d32_m == pytest.approx(2 * RADIUS, rel=0.02)
    middles = found.left_out.mean(axis=1)
    assert (middles[:, 1] > TOP - 15.0).all()


def test_the_face_of_a_ruler_is_found_however_its_line_lies():
    """The line that was followed may cross the ticks aslant, and goes on beside a short ruler."""
    picture = photograph(close_up(10.3, (240, 238, 230), length=300.0))
    ruler = find_ruler(grey_of(picture))
    aslant = ruler._replace(line=np.array([[0.0, TOP + 4.0], [699.0, TOP + 18.0]]))
    for one in (ruler, aslant):
        (left, top), (right, bottom) = (
            edge(face_of(picture, one), axis=0) for edge in (np.min, np.max)
        )
        assert top == pytest.approx(TOP, abs=25.0)
        assert bottom == pytest.approx(BOTTOM, abs=25.0)
        assert left < LEFT
        assert LEFT + 300.0 < right < LEFT + 420.0


def test_a_ruler_alone_has_no_grains():
    picture = photograph(close_up(10.3, (195, 193, 190)))
    found = measure_sizes(picture, 1.0)
    ruler = find_ruler(grey_of(picture))
    corners = face_of(picture, ruler)
    over = found.outlines.mean(axis=1)[:, 1] > corners[:, 1].min()
    assert over.any(), "numbers of a clear ruler look like grains"
    only = type(found)(
        **{
            **vars(found),
            "diameters_m": found.diameters_m[over],
            "circularities": found.circularities[over],
            "outlines": found.outlines[over],
        }
    )
    with pytest.raises(CaseError, match="but what lies on the ruler"):
        without_ruler(only, picture, ruler)


@pytest.mark.parametrize("blur", [1.0, 2.5])
def test_ticks_of_one_length_do_not_tell_where_the_face_is(blur: float):
    """Taken for the side of the grains, it held all of them, and the picture was refused."""
    light, rng = np.full((500, 700, 3), 205.0), np.random.default_rng(1)
    for k in range(GRAINS):
        x, y = np.array([60 + 72 * (k % 9), 50 + 90 * (k // 9)]) + rng.uniform(-15, 15, 2)
        cv2.circle(light, (round(x), round(y)), 14, (70.0, 65.0, 60.0), -1)
    light[TOP:] = 240.0
    for k in range(33):
        light[TOP : TOP + 18, 20 + 20 * k : 22 + 20 * k] = 20.0
    seen = cv2.GaussianBlur(light, (0, 0), blur) + rng.normal(0.0, 2.0, light.shape)
    picture = np.clip(seen, 0, 255).astype(np.uint8)
    found = without_ruler(measure_sizes(picture, 1.0), picture, find_ruler(grey_of(picture)))
    assert found.count == GRAINS


@pytest.mark.parametrize(("tick", "blur"), [(20.6, 0.0), (20.6, 3.0), (10.3, 2.0), (6.6, 0.0)])
def test_longer_ticks_show_that_these_are_the_finest(tick: float, blur: float):
    picture = photograph(close_up(tick, (240, 238, 230)))
    if blur:
        picture = cv2.GaussianBlur(picture, (0, 0), blur)
    grey = grey_of(picture)
    assert are_finest(grey, find_ruler(grey))
