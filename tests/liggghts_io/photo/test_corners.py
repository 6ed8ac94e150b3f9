"""Corners that a program has filled, as it turned a photograph, hold nothing that was seen."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from liggghts_io.photo.colour import grey_of
from liggghts_io.photo.corners import without_corners
from liggghts_io.photo.grains.sizes import measure_sizes
from liggghts_io.photo.heap import measure_heap
from liggghts_io.photo.ruler import find_ruler
from tests.liggghts_io.photo import heaps, scene

BLACK, WHITE = 0, 255


def turned(photo, degrees, shade, *, larger):
    """Return a photograph turned about its middle, on a canvas of its size or one that holds it."""
    rows, columns = photo.shape[:2]
    about = cv2.getRotationMatrix2D((columns / 2, rows / 2), degrees, 1.0)
    size = (columns, rows)
    if larger:
        c, s = abs(about[0, 0]), abs(about[0, 1])
        size = (round(rows * s + columns * c), round(rows * c + columns * s))
        about[:, 2] += [0.5 * (size[0] - columns), 0.5 * (size[1] - rows)]
    seen = cv2.warpAffine(np.ones((rows, columns), np.float32), about, size)
    picture = cv2.warpAffine(photo, about, size, flags=cv2.INTER_CUBIC, borderValue=(shade,) * 3)
    return picture, seen < 0.5


def spread_grains(**said):
    grey, truth = scene.photograph(scene.Scene(**said))
    return np.repeat(grey[:, :, None], 3, axis=2), truth


def compressed(photo):
    return heaps.through_jpeg(photo, 80)


@pytest.mark.parametrize("shade", [BLACK, WHITE])
@pytest.mark.parametrize("kept", [np.asarray, compressed])
@pytest.mark.parametrize(("degrees", "larger"), [(2.0, False), (-7.0, True), (40.0, True)])
def test_what_no_camera_saw_is_found(degrees, larger, kept, shade):
    photo, _ = spread_grains(ground=130.0, grain=30.0)
    picture, hidden = turned(photo, degrees, shade, larger=larger)
    filled, missing = without_corners(kept(picture))
    assert not (hidden & ~missing).any()
    # and a seam of three pixels beside it, where the edge is blurred
    assert missing.mean() < hidden.mean() + 0.02
    # the ground and the grains go on there, as bright as they are
    for part in (0.02, 0.5):
        levels = [np.quantile(one, part) for one in (filled[missing], filled[~missing])]
        assert levels[0] == pytest.approx(levels[1], abs=15.0)


def test_a_turned_photograph_of_grains_has_their_sizes():
    photo, truth = spread_grains(ruler=True)
    expected = measure_sizes(photo, 1.0)
    for degrees, shade in ((-20.0, WHITE), (4.0, BLACK)):
        picture, _ = turned(photo, degrees, shade, larger=True)
        found = measure_sizes(picture, 1.0)
        assert len(found.diameters_m) == pytest.approx(len(truth.diameters), rel=0.1)
        assert found.d32_m == pytest.approx(expected.d32_m, rel=0.01)
        filled, missing = without_corners(picture)
        assert find_ruler(grey_of(filled), missing).pixels == pytest.approx(30.0, rel=0.003)


def test_a_turned_photograph_that_was_cut_counts_whole_grains_only():
    photo, _ = spread_grains(count=200)
    picture, hidden = turned(photo, 15.0, BLACK, larger=False)
    found = measure_sizes(picture, 1.0)
    assert found.d32_m == pytest.approx(measure_sizes(photo, 1.0).d32_m, rel=0.02)
    x, y = np.rint(np.moveaxis(found.outlines, -1, 0)).astype(int)
    assert not hidden[y, x].any()
    assert "cut by the border" in found.reasons


@pytest.mark.parametrize("shade", [BLACK, WHITE])
def test_a_levelled_photograph_of_a_heap_has_its_angle(shade):
    photo = heaps.photograph(heaps.Pile(noise=4.0, size=(640, 300), height=120.0))
    bare = measure_heap(photo)
    for degrees in (-3.0, 8.0):
        heap = measure_heap(turned(photo, degrees, shade, larger=True)[0])
        assert heap.repose.angle_deg == pytest.approx(bare.repose.angle_deg, abs=0.3)


def test_pictures_that_nobody_turned_stay_as_they_are(rng):
    photo, _ = spread_grains()
    shelf = photo.copy()  # one dark corner: of a table, or a finger
    cv2.fillPoly(shelf, [np.array([[0, 0], [200, 0], [0, 90]])], (0, 0, 0))
    corners = photo.copy()  # two of them that no turn of a picture makes
    for x in (0, photo.shape[1] - 1):
        cv2.fillPoly(corners, [np.array([[x, 0], [abs(x - 200), 0], [x, 90]])], (0, 0, 0))
    noise = rng.integers(0, 255, photo.shape, dtype=np.uint8)
    for one in (photo, shelf, corners, noise, np.zeros_like(photo), photo[:20, :20]):
        filled, missing = without_corners(one)
        assert filled is one
        assert not missing.any()
