"""Angles of drawn heaps, whatever surrounds them; and pictures without a heap."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from liggghts_io import CaseError
from liggghts_io.photo.heap import measure_heap
from tests.liggghts_io.photo.heaps import Pile, photograph
from tests.liggghts_io.photo.scene import Scene
from tests.liggghts_io.photo.scene import photograph as photograph_of_grains

WITHIN_DEG = 0.3
"""What is asked for; smooth flanks are met to 0.1."""

PILES = {
    "plain": Pile(),
    "steep": Pile(left=46.2, right=46.2),
    "shallow": Pile(left=20.0, right=20.0, height=130.0),
    "unequal flanks": Pile(left=30.0, right=38.0),
    "rounded crest": Pile(rounded=0.05),
    "camera tilted right": Pile(tilt=3.0),
    "camera tilted left": Pile(tilt=-5.0),
    "off centre": Pile(middle=0.36, height=190.0),
    "texture": Pile(texture=10.0),
    "shadow": Pile(shadow=0.3),
    "shadow on the wall": Pile(shadow=0.45, reach=1.6),
    "shadow on the wall, nearly as dark as the heap": Pile(
        shadow=0.45, reach=1.3, grain=(95, 100, 95)
    ),
    "darker shadow on the wall": Pile(shadow=0.5, reach=1.3, grain=(95, 90, 85)),
    "funnel": Pile(funnel=True),
    "grains still fall": Pile(funnel=True, stream=16.0),
    "bar above": Pile(things=((0.0, 0.0, 1.0, 0.12),)),
    "tray": Pile(plate_width=760.0, plate_thickness=25.0),
    "block": Pile(plate_width=720.0),
    "no plate to be seen": Pile(plate=0.0),
    "plate as dark as the heap": Pile(table=(75, 66, 60)),
    "plate as bright as the wall": Pile(table=(208, 206, 198)),
    "light heap": Pile(ground=(25, 25, 30), grain=(200, 195, 185), table=(60, 60, 60)),
    "light heap and plate": Pile(ground=(25, 25, 30), grain=(200, 195, 185), table=(190, 190, 188)),
    "colours of equal brightness": Pile(ground=(90, 140, 200), grain=(170, 110, 80)),
    "low contrast": Pile(ground=(150, 148, 145), grain=(110, 106, 103), table=(130, 130, 130)),
    "uneven light": Pile(slope=0.6, vignette=0.4),
    "blurred": Pile(blur=3.0),
    "noisy": Pile(noise=15.0),
    "compressed": Pile(jpeg=40),
    "small in the picture": Pile(height=90.0),
    "small picture": Pile(height=70.0, size=(320, 150), plate=25.0),
    "spilled grains": Pile(spilled=40),
    "grains": Pile(grains=5.0),
    "grains and all else": Pile(
        grains=5.0, tilt=2.0, middle=0.46, texture=6.0, shadow=0.25, funnel=True, plate_width=850.0,
        jpeg=80, noise=5.0,
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", PILES)
def test_known_angle(name: str):
    pile = PILES[name]
    found = measure_heap(photograph(pile))
    repose = found.repose
    assert repose.angle_deg == pytest.approx(0.5 * (pile.left + pile.right), abs=WITHIN_DEG)
    assert repose.left_deg == pytest.approx(pile.left, abs=2 * WITHIN_DEG)
    assert repose.right_deg == pytest.approx(pile.right, abs=2 * WITHIN_DEG)
    assert found.plate.tilt_deg == pytest.approx(pile.tilt, abs=0.25)


EVEN: dict[str, Any] = {"ground": (175, 175, 175), "vignette": 0.0}
TRAY: dict[str, Any] = {"plate_width": 600.0, "plate_thickness": 30.0}
LEFT, RIGHT = (0.0, 0.0, 0.075, 1.0), (0.97, 0.0, 1.0, 1.0)


@pytest.mark.parametrize(("post", "seen"), [(LEFT, {}), (LEFT, EVEN), (RIGHT, EVEN), (LEFT, TRAY)])
def test_a_post_beside_the_heap(post: tuple[float, ...], seen: dict[str, Any]):
    """It hides an end of the plate, so that flanks are known less well than their mean."""
    found = measure_heap(photograph(Pile(things=(post,), **seen)))
    assert found.repose.angle_deg == pytest.approx(34.0, abs=WITHIN_DEG)
    assert found.plate.tilt_deg == pytest.approx(0.0, abs=1.0)


def test_a_level_line_counts_instead_of_the_plate():
    """Seen by a camera tilted by 3 degrees, with a line that is level in truth."""
    picture = photograph(Pile(tilt=3.0))
    slope = np.tan(np.radians(3.0))
    row = 460.0 - 80.0
    line = ((100.0, row - 400.0 * slope), (900.0, row + 400.0 * slope))
    repose = measure_heap(picture, line).repose
    assert repose.angle_deg == pytest.approx(34.0, abs=WITHIN_DEG)
    above = ((0.0, 50.0), (1000.0, 50.0 + 1000.0 * slope))
    assert measure_heap(picture, above).repose.angle_deg == pytest.approx(34.0, abs=WITHIN_DEG)
    # Told that the picture's rows are level, one flank is steeper by the tilt, the other flatter.
    crooked = measure_heap(picture, ((100.0, row), (900.0, row))).repose
    assert crooked.right_deg - crooked.left_deg == pytest.approx(6.0, abs=0.6)


@pytest.mark.parametrize(
    ("line", "said"),
    [(((0.0, 9e3), (99.0, 9e3)), "not in the picture"), (((10.0, 9.0), (20.0, 99.0)), "too steep")],
)
def test_a_level_line_that_cannot_be_is_refused(line, said: str):
    with pytest.raises(CaseError, match=said):
        measure_heap(photograph(Pile(size=(320, 150), height=70.0, plate=25.0)), line)


def test_the_standard_error_tells_the_scatter_of_rough_heaps():
    """Over several heaps of coarse grains, deviations are as large as stated, to a factor of 2.5.

    Eight heaps: the sum of their squared deviations in errors is chi-square with eight degrees of
    freedom, whose ends of 1e-3 are 0.9 and 26; neighbouring grains of a drawing add to that.
    """
    small = {"size": (600, 300), "height": 130.0, "plate": 50.0}
    found = [measure_heap(photograph(Pile(grains=6.0, seed=k, **small))).repose for k in range(8)]
    angles = np.array([one.angle_deg for one in found])
    stated = np.array([one.se_deg for one in found])
    ratio = angles.std(ddof=1) / np.sqrt(np.mean(stated**2))
    assert 1 / 2.5 < ratio < 2.5
    smooth = measure_heap(photograph(Pile(**small))).repose
    assert smooth.se_deg < 0.2 * stated.min()


def test_mirror_image_swaps_the_flanks():
    picture = photograph(Pile(left=31.0, right=37.0, middle=0.45, noise=0.0))
    one = measure_heap(picture).repose
    other = measure_heap(np.ascontiguousarray(picture[:, ::-1])).repose
    assert one.left_deg == pytest.approx(other.right_deg, abs=0.1)
    assert one.right_deg == pytest.approx(other.left_deg, abs=0.1)


def test_a_heap_cut_by_the_border_has_one_flank():
    repose = measure_heap(photograph(Pile())[:, :500]).repose
    assert repose.left_deg == pytest.approx(34.0, abs=WITHIN_DEG)
    assert np.isnan(repose.right_deg)
    assert repose.angle_deg == repose.left_deg


def _plain(values: np.ndarray) -> np.ndarray:
    grey = np.clip(np.broadcast_to(values, (460, 1000)), 0, 255).astype(np.uint8)
    return np.repeat(grey[:, :, None], 3, axis=2)


Y, X = np.mgrid[0:460, 0:1000].astype(float)
GREY = Pile(
    ground=(205, 205, 205), grain=(60, 66, 75), table=(140, 140, 140),
    size=(1200, 800), plate=180.0, slope=0.0, vignette=0.0,
)  # fmt: skip
NO_HEAPS = {
    "grey": _plain(np.array(128.0)),
    "noise": _plain(128 + 20 * np.random.default_rng(1).standard_normal(X.shape)),
    "light falls off": _plain(50 + 0.15 * X + 0.1 * Y),
    "plate alone": _plain(np.where(Y > 370, 80, 210)),
    "slanting plate alone": _plain(np.where(Y > 330 + 0.08 * X, 80, 210)),
    "box": _plain(np.where(((Y > 200) & (np.abs(X - 500) < 180)) | (Y > 400), 80, 210)),
    "ball": _plain(np.where(np.hypot(X - 500, Y - 230) < 150, 80, 210)),
    "half a ball": _plain(np.where((np.hypot(X - 500, Y - 400) < 200) | (Y > 400), 80, 210)),
    "chessboard": _plain(np.where((X // 60 + Y // 60) % 2 > 0, 80, 200)),
    "stripes": _plain(np.where((X + Y) // 80 % 2 > 0, 80, 200)),
    "narrow stripes": _plain(np.where(X % 20 < 12, 200, 50)),
    "grains from above": np.repeat(photograph_of_grains(Scene(count=60))[0][:, :, None], 3, axis=2),
    "upside down": np.ascontiguousarray(photograph(Pile())[::-1]),
    "lying on its side": np.ascontiguousarray(np.rot90(photograph(Pile()))),
    "lying on its other side": np.ascontiguousarray(np.rot90(photograph(Pile()), 3)),
    "lying on its side, as a wall beside a heap": np.ascontiguousarray(
        np.rot90(photograph(replace(GREY, left=32.0, right=32.0, height=190.0)))
    ),
    "funnel without heap": photograph(Pile(height=1.0, size=(600, 400), funnel=True, grains=0.0)),
}


@pytest.mark.parametrize("name", NO_HEAPS)
def test_no_heap_no_number(name: str):
    with pytest.raises(CaseError, match="no heap in the picture"):
        measure_heap(NO_HEAPS[name])


def test_a_photo_of_a_simulated_heap_gives_the_angle_of_its_silhouette():
    """One measure for both: the silhouette of a simulation, taken as a photograph."""
    from liggghts_io.measure.silhouette import angle_of_repose, draw_silhouette

    rng = np.random.default_rng(5)
    x, z = rng.uniform(-30.0, 30.0, 6000), rng.uniform(0.5, 20.0, 6000)
    keep = z <= (30.0 - np.abs(x)) * np.tan(np.radians(33.0))
    x, z = x[keep], z[keep]
    grey = draw_silhouette(x, z, np.full_like(x, 0.5), 1.0 / 20.0).image
    direct = angle_of_repose(grey, dark_heap=True)
    photo = measure_heap(np.repeat(grey[:, :, None], 3, axis=2)).repose
    assert photo.angle_deg == pytest.approx(direct.angle_deg, abs=0.1)
