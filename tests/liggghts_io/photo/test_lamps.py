"""Heaps of grains that a lamp lights from the side, and what hangs into them or is cut off."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from liggghts_io import CaseError
from liggghts_io.measure.flanks import FlankFit, fit_flanks
from liggghts_io.photo.heap import measure_heap
from liggghts_io.photo.heap_checks import check_heap
from tests.liggghts_io.photo.heaps import ColourImage, through_jpeg

WITHIN_DEG = 0.8
"""Grains of 5 px on flanks of 300 px: the outline itself scatters by 0.3 degrees."""
COLUMNS, ROWS, PLATE, HEIGHT = 900, 560, 460, 190.0


def _grains(rng: np.random.Generator) -> np.ndarray:
    """Return an uneven surface as of grains of 5 px, with a standard deviation of 1."""
    rough = cv2.GaussianBlur(rng.standard_normal((ROWS, COLUMNS)), (0, 0), 1.8)
    return np.asarray(rough / rough.std())


def lit_from(
    azimuth: float, wall: float, angle: float, *, funnel: float = 0.0, tile: float = 0.0
) -> ColourImage:
    """Return a photograph of a cone by Lambert's law.

    Parameters
    ----------
    azimuth : float
        Of the lamp: 90 from the right, -90 from the left, 0 from the camera [deg].
    wall : float
        Brightness of the wall, from 0 to 1; grains have 0.5.
    angle : float
        Of repose [deg].
    funnel : float
        Half width of a funnel's tip that hangs into the top [px]; 0: none.
    tile : float
        Side of the tiles of the wall [px]; 0: none.
    """
    rng = np.random.default_rng(3)
    y, x = np.mgrid[:ROWS, :COLUMNS] + 0.5
    across, up = x - 0.5 * COLUMNS, PLATE - y
    steep = np.tan(np.radians(angle))
    side, high = np.radians(azimuth), np.radians(25.0)
    lamp = np.cos(high) * np.sin(side), np.cos(high) * np.cos(side), np.sin(high)
    rough = _grains(rng)
    uneven = 1.5 * rough[:1] / rough[0].std()
    inside = (up >= 0.0) & (up < HEIGHT - steep * np.abs(across) + uneven)
    around = np.clip(across * steep / np.maximum(HEIGHT - up, 1e-3), -1.0, 1.0)
    normal = np.stack([steep * around + 0.5 * np.gradient(rough, axis=1),
                       steep * np.sqrt(1.0 - around**2),
                       1.0 - 0.5 * np.gradient(rough, axis=0)])  # fmt: skip
    facing = np.tensordot(lamp, normal / np.linalg.norm(normal, axis=0), axes=1)
    grains = 0.5 * (0.2 + np.clip(facing, 0.0, None)) * (1.0 + 0.1 * rough)
    light = np.where(up < 0.0, 0.33, wall * (0.3 + 0.7 * max(lamp[1], 0.0)) * (1 + across / 6e3))
    if tile:  # with joints half as bright, which begin at the plate
        light[((x % tile < 3.0) | (up % tile < 3.0)) & (up > 0.0)] *= 0.5
    light = np.where(inside, grains, light)
    light[(np.hypot(across, 4.0 * up) < HEIGHT / steep) & (up < 0.0)] = 0.12  # its shadow
    if funnel:
        over = up - 0.9 * HEIGHT
        light[(over > 0.0) & (np.abs(across) < funnel + np.maximum(0.0, over - 40.0))] = 0.4
    seen = 255.0 * cv2.GaussianBlur(light, (0, 0), 1.0) ** 0.7 + 2.5 * rng.standard_normal(x.shape)
    pixels = np.clip(np.round(seen), 0, 255).astype(np.uint8)
    return through_jpeg(np.repeat(pixels[:, :, None], 3, axis=2), 80)


@pytest.mark.parametrize(
    ("azimuth", "wall", "angle"),
    [(-90.0, 0.8, 24.0), (75.0, 0.8, 37.0), (80.0, 0.4, 28.0), (-60.0, 0.3, 33.0),
     (-110.0, 0.9, 40.0)],
)  # fmt: skip
def test_one_flank_bright_and_the_other_in_its_own_shadow(
    azimuth: float, wall: float, angle: float
):
    """Somewhere on it the heap is as bright as the wall: levels of light refuse it, or cut it."""
    repose = measure_heap(lit_from(azimuth, wall, angle)).repose
    assert repose.left_deg == pytest.approx(angle, abs=2 * WITHIN_DEG)
    assert repose.right_deg == pytest.approx(angle, abs=2 * WITHIN_DEG)
    assert repose.angle_deg == pytest.approx(angle, abs=WITHIN_DEG)


@pytest.mark.parametrize("half", [20.0, 45.0])
def test_a_funnel_hangs_into_the_top(half: float):
    """Its tip is a tenth of the picture's width: more than any stream of grains."""
    repose = measure_heap(lit_from(20.0, 0.9, 33.0, funnel=half)).repose
    assert repose.angle_deg == pytest.approx(33.0, abs=WITHIN_DEG)


def test_a_wall_of_tiles():
    """Joints join the heap to a net over all of the wall: it was refused as no heap."""
    repose = measure_heap(lit_from(20.0, 0.9, 33.0, tile=110.0)).repose
    assert repose.angle_deg == pytest.approx(33.0, abs=WITHIN_DEG)


@pytest.mark.parametrize("cut", [False, True])
def test_one_flank_is_enough_only_where_the_border_hides_the_other(cut: bool):
    """A heap 100 px high that falls off a cliff; behind that, its plate reaches the border."""
    x = np.arange(0.5, 300.0)
    z = np.where(x < 200.0, np.clip(0.5 * x, 2.0, None), 2.0)
    mask = np.arange(120)[::-1, None] < z
    if cut:
        x, z, mask = x[:200], z[:200], mask[:, :200]
    image = np.where(mask, 0, 255).astype(np.uint8)
    repose = fit_flanks(np.column_stack([x, z]), FlankFit(), one_is_enough=True)
    assert np.isnan(repose.right_deg)
    if cut:
        check_heap(repose, mask, image)
        return
    with pytest.raises(CaseError, match="no straight flank on the right"):
        check_heap(repose, mask, image)


def test_the_most_telling_reason_is_told():
    """Beside a box lie flat things; that they are flat helps nobody."""
    light = np.full((ROWS, COLUMNS, 3), 210, np.uint8)
    light[PLATE:] = 120
    light[PLATE - 8 : PLATE, 40:300] = 60
    light[200:PLATE, 500:700] = 60
    with pytest.raises(CaseError, match="what stands out") as told:
        measure_heap(light)
    assert "px" not in str(told.value)
