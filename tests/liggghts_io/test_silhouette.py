"""The image routine on drawn heaps of known angle."""

import cv2
import numpy as np
import pytest

from liggghts_io import CaseError
from liggghts_io.measure.flanks import FlankFit, fit_line
from liggghts_io.measure.silhouette import angle_of_repose, draw_silhouette

# A drawn edge is whole pixels: 0.5 px over a flank of 250 px is 0.1 deg; noise is given 0.5 deg.
CLEAN_DEG = 0.15
NOISY_DEG = 0.5


def triangle(left, right=None, height=260, shape=(420, 900), heap=30, paper=225):
    """Draw a triangular heap that stands on the lower border."""
    right = left if right is None else right
    image = np.full(shape, paper, dtype=np.uint8)
    centre = shape[1] // 2
    corners = np.array(
        [
            [centre - height / np.tan(np.radians(left)), shape[0] - 1],
            [centre, shape[0] - 1 - height],
            [centre + height / np.tan(np.radians(right)), shape[0] - 1],
        ]
    )
    cv2.fillPoly(image, [np.round(corners * 256).astype(np.int32)], heap, cv2.LINE_AA, 8)
    return image


@pytest.mark.parametrize("angle", [30.0, 34.1, 38.28, 42.0, 46.0])
def test_triangle(angle):
    found = angle_of_repose(triangle(angle))
    assert found.angle_deg == pytest.approx(angle, abs=CLEAN_DEG)
    assert found.height_m == pytest.approx(260, abs=2)


def test_angle_of_a_line_has_all_digits_whatever_the_order_of_points(rng):
    """Against the principal axis; single precision is off by 1e-7 deg, more on other machines."""
    x = np.linspace(0.01, 0.05, 300)
    points = np.column_stack([x, 0.7 * x + rng.normal(0.0, 1e-4, x.size)])
    line, angle = fit_line(points)
    _, _, axes = np.linalg.svd(points - points.mean(axis=0))
    wanted = np.degrees(np.arctan2(*np.abs(axes[0, ::-1])))
    assert angle == pytest.approx(wanted, rel=1e-12)
    np.testing.assert_allclose(np.diff(line, axis=0)[0] @ axes[1], 0.0, atol=1e-15)  # m, of 0.05
    assert fit_line(rng.permutation(points))[1] == angle


def test_flanks_are_measured_apart_and_averaged():
    found = angle_of_repose(triangle(32.0, 44.0))
    assert found.left_deg == pytest.approx(32.0, abs=CLEAN_DEG)
    assert found.right_deg == pytest.approx(44.0, abs=CLEAN_DEG)
    assert found.angle_deg == pytest.approx(38.0, abs=CLEAN_DEG)


def test_bright_heap_on_a_dark_ground():
    assert angle_of_repose(255 - triangle(40.0)).angle_deg == pytest.approx(40.0, abs=CLEAN_DEG)


@pytest.mark.parametrize("slope", [(40.0, 0.0), (-35.0, 25.0)])
def test_noise_dust_and_tilted_illumination(rng, slope):
    image = triangle(36.2).astype(float)
    rows, columns = image.shape
    image += np.linspace(-slope[0], slope[0], columns)[None, :]
    image += np.linspace(-slope[1], slope[1], rows)[:, None]
    image += rng.normal(0.0, 12.0, image.shape)
    for _ in range(60):  # grains that lie apart on the plate
        x = int(rng.integers(0, columns))
        cv2.circle(image, (x, rows - 3), 3, 30.0, -1)
    found = angle_of_repose(np.clip(image, 0, 255).astype(np.uint8))
    assert found.angle_deg == pytest.approx(36.2, abs=NOISY_DEG)


@pytest.mark.parametrize("invert", [False, True])
def test_a_small_heap_in_a_wide_picture(invert):
    image = triangle(36.0, height=150, shape=(420, 1600))
    found = angle_of_repose(255 - image if invert else image)
    assert found.angle_deg == pytest.approx(36.0, abs=2 * CLEAN_DEG)  # flanks of half the pixels


def test_scale_changes_lengths_only():
    near, far = angle_of_repose(triangle(35.0)), angle_of_repose(triangle(35.0), 1e-4)
    assert far.angle_deg == pytest.approx(near.angle_deg, abs=1e-3)
    assert far.height_m == pytest.approx(near.height_m * 1e-4)
    assert far.lines[0] == pytest.approx(near.lines[0] * 1e-4, rel=1e-3)


def test_mirror_image_swaps_the_flanks():
    image = triangle(33.0, 41.0)
    one, other = angle_of_repose(image), angle_of_repose(np.ascontiguousarray(image[:, ::-1]))
    assert one.left_deg == pytest.approx(other.right_deg, abs=0.05)


def test_drawn_grains_on_a_slope():
    """Spheres of a filled wedge: the fitted line follows their upper edge."""
    d, slope = 1.0, np.radians(37.0)
    x, z = np.meshgrid(np.arange(-20.0, 20.5, 0.5), np.arange(0.5, 16.0, 0.5))
    keep = z <= (20.0 - np.abs(x)) * np.tan(slope)
    x, z = x[keep], z[keep]
    image = draw_silhouette(x, z, np.full_like(x, d / 2), d / 16).image
    # Grains on a lattice of half a diameter make steps of that size over a flank of 15 diameters.
    assert angle_of_repose(image, dark_heap=True).angle_deg == pytest.approx(37.0, abs=1.0)


def test_no_heap_no_number(rng):
    flat = np.full((200, 300), 200, dtype=np.uint8)
    with pytest.raises(CaseError, match="no heap"):
        angle_of_repose(flat, dark_heap=True)


def test_a_heap_cut_off_at_the_top_is_refused():
    with pytest.raises(CaseError, match="upper border"):
        angle_of_repose(triangle(40.0)[170:], dark_heap=True)


def test_a_flank_too_short_is_refused():
    with pytest.raises(CaseError, match="flank"):
        angle_of_repose(triangle(40.0), fit=FlankFit(0.5, 0.502))


@pytest.mark.parametrize("image", [np.zeros((50, 50, 3), np.uint8), np.zeros((50, 50))])
def test_other_images_are_refused(image):
    with pytest.raises(CaseError, match="grey"):
        angle_of_repose(image)


def test_no_grain_above_the_plate():
    with pytest.raises(CaseError, match="no grain"):
        draw_silhouette(np.zeros(1), np.array([-1.0]), np.ones(1), 0.1)
