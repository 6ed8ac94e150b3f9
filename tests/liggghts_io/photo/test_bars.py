"""Bars around a photograph, as screens and films have them, are no part of it."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from liggghts_io.photo.bars import without_bars
from liggghts_io.photo.heap import measure_heap
from tests.liggghts_io.photo.heaps import Pile, photograph

BLACK, WHITE, GREY = 0, 255, 128


def framed(photo, rows, columns, shade):
    """Return a photograph between bars: thickness above, below; left, right [px]."""
    edges = (*rows, *columns)
    return cv2.copyMakeBorder(photo, *edges, cv2.BORDER_CONSTANT, value=(shade,) * 3)


def inner(photo):
    rows, columns = without_bars(photo)
    return rows.start, rows.stop, columns.start, columns.stop


def compressed(photo):
    return cv2.imdecode(cv2.imencode(".jpg", photo, [cv2.IMWRITE_JPEG_QUALITY, 70])[1], 1)


def test_a_heap_between_bars_is_the_same_heap():
    photo = photograph(Pile(noise=4.0, size=(640, 300), height=120.0))
    bare = measure_heap(photo)
    heap = measure_heap(compressed(framed(photo, (60, 62), (40, 40), BLACK)))
    assert heap.repose.angle_deg == pytest.approx(bare.repose.angle_deg, abs=0.3)
    np.testing.assert_allclose(heap.lines - np.array([40.0, 60.0]), bare.lines, atol=4.0)
    assert heap.plate.x - 40 == pytest.approx(bare.plate.x, abs=4.0)
    assert heap.plate.y - 60 == pytest.approx(bare.plate.y, abs=4.0)
    # a line given on the photograph is one of the photograph
    levelled = measure_heap(photo, ((100.0, 250.0), (500.0, 255.0)))
    moved = measure_heap(framed(photo, (60, 60), (0, 0), BLACK), ((100.0, 310.0), (500.0, 315.0)))
    assert moved.repose.angle_deg == pytest.approx(levelled.repose.angle_deg, abs=0.3)


@pytest.mark.parametrize("shade", [BLACK, WHITE, GREY])
@pytest.mark.parametrize("kept", [compressed, np.asarray])
def test_bars_are_left_out(shade, kept):
    photo = photograph(Pile(noise=4.0))
    rows, columns = photo.shape[:2]
    assert inner(kept(photo)) == (0, rows, 0, columns)
    # three pixels beside a bar, where both mix, go as well
    found = inner(kept(framed(photo, (96, 96), (160, 152), shade)))
    np.testing.assert_allclose(found, (99, 93 + rows, 163, 157 + columns), atol=6)
    found = inner(kept(framed(photo, (0, 0), (160, 152), shade)))
    np.testing.assert_allclose(found, (0, rows, 163, 157 + columns), atol=6)
    # one bar alone may be a table or a wall
    assert inner(kept(framed(photo, (48, 0), (0, 0), shade))) == (0, 48 + rows, 0, columns)
    assert inner(kept(framed(photo, (96, 40), (0, 0), shade))) == (0, 136 + rows, 0, columns)


def test_even_backgrounds_are_no_bars():
    """A heap drawn on white, without noise: above it, below its plate, on both sides."""
    drawn = np.full((300, 500, 3), WHITE, np.uint8)
    cv2.fillPoly(drawn, [np.array([[100, 200], [250, 90], [400, 200]])], (60, 60, 60))
    assert inner(drawn) == (0, 300, 0, 500)
    cv2.rectangle(drawn, (0, 200), (499, 240), (90, 90, 90), -1)
    assert inner(drawn) == (0, 300, 0, 500)
    drawn[:] = BLACK
    assert inner(drawn) == (0, 300, 0, 500)
