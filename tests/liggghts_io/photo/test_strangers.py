"""Photographs as others draw them: grains that are shaded, shine or lie in a dish, odd pictures.

They owe nothing to the generators beside this file, whose habits the routines were built with.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import nullcontext
from typing import Final

import cv2
import numpy as np
import pytest

from liggghts_io import CaseError
from liggghts_io.measure.flanks import FlankFit, fit_flanks
from liggghts_io.photo.grains.sizes import measure_sizes
from liggghts_io.photo.heap import measure_heap
from liggghts_io.photo.heap_checks import check_heap

WITHIN = 0.02
"""What is asked for, of d32 and of circularity."""
WITHIN_DEG = 0.3
SIZE = (460, 380)  # columns, rows
FINER = 6

Shade = Callable[[np.ndarray, np.ndarray], np.ndarray]


def _spread(rng: np.random.Generator, radii: np.ndarray, gap: float = 5.0) -> np.ndarray:
    """Return centres of discs that do not touch, from the largest on."""
    places: list[np.ndarray] = []
    for k, radius in enumerate(radii):
        for _ in range(5000):
            low = radius + gap
            at = rng.uniform((low, low), (SIZE[0] - low, SIZE[1] - low))
            apart = [np.hypot(*(at - one)) - radii[j] for j, one in enumerate(places)]
            if not apart or min(apart) > radius + gap:
                break
        else:
            msg = f"no room for disc {k}"
            raise ValueError(msg)
        places.append(at)
    return np.array(places)


def _draw(light: np.ndarray, centres: np.ndarray, radii: np.ndarray, shade: Shade) -> None:
    """Lay discs into the light; `shade` gives their brightness over the disc of radius 1."""
    rows, columns = light.shape
    for (x, y), radius in zip(centres, radii, strict=True):
        left, top = int(x - radius) - 1, int(y - radius) - 1
        side = int(2 * radius) + 4
        fine = (np.arange(side * FINER) + 0.5) / FINER
        u, v = np.meshgrid((left + fine - x) / radius, (top + fine - y) / radius)
        inside = u**2 + v**2 <= 1.0

        def whole(values: np.ndarray, side: int = side) -> np.ndarray:
            return values.reshape(side, FINER, side, FINER).mean(axis=(1, 3))

        part, ink = whole(inside.astype(float)), whole(np.where(inside, shade(u, v), 0.0))
        window = light[
            max(top, 0) : min(top + side, rows), max(left, 0) : min(left + side, columns)
        ]
        window *= 1.0 - part[: window.shape[0], : window.shape[1]]
        window += ink[: window.shape[0], : window.shape[1]]


def _camera(light: np.ndarray, rng: np.random.Generator, noise: float = 3.0) -> np.ndarray:
    seen = cv2.GaussianBlur(light, (0, 0), 0.7) + noise * rng.standard_normal(light.shape)
    return np.repeat(np.clip(np.round(seen), 0, 255).astype(np.uint8)[:, :, None], 3, axis=2)


def _flat(level: float) -> Shade:
    return lambda u, v: np.full(u.shape, level)


def _ball(lit: float, dark: float) -> Shade:
    """Return a ball that is `lit` in its middle and `dark` at its rim."""
    return lambda u, v: dark + (lit - dark) * np.sqrt(np.clip(1.0 - u**2 - v**2, 0.0, 1.0))


SHADES: dict[str, tuple[float, Shade]] = {
    "lit balls on black": (20.0, _ball(230.0, 120.0)),
    "dark balls with a lighter middle": (225.0, _ball(130.0, 50.0)),
    "a dark line around each": (220.0, lambda u, v: np.where(u**2 + v**2 < 0.72, 110.0, 30.0)),
    "glass beads, light in the middle": (
        210.0, lambda u, v: np.where(u**2 + v**2 < 0.25, 190.0, 50.0),
    ),
    "soft reflections": (
        200.0, lambda u, v: 50.0 + 180.0 * np.exp(-6.0 * ((u + 0.2) ** 2 + (v + 0.2) ** 2)),
    ),
    "sharp reflections": (
        200.0, lambda u, v: np.where((u + 0.3) ** 2 + (v + 0.3) ** 2 < 0.09, 250.0, 40.0),
    ),
}  # fmt: skip


def _d32(radii: np.ndarray) -> float:
    return float(2.0 * np.sum(radii**3) / np.sum(radii**2))


REFLECTIONS: Final = 12.0  # px, the least radius of grains with a light of their own
SHADED: Final = [
    (name, radius)
    for name in SHADES
    for radius in (16.0, 12.0, 7.0)
    if radius >= REFLECTIONS or "reflections" not in name
]


@pytest.mark.parametrize(("name", "radius"), SHADED)
def test_the_edge_lies_at_half_the_brightness_of_the_rim(name: str, radius: float):
    """At half that of the middle, lit balls are 4 % too small, the others 3 % too large or none."""
    ground, shade = SHADES[name]
    rng = np.random.default_rng(1)
    radii = rng.normal(radius, 0.1 * radius, 24)
    light = np.full(SIZE[::-1], ground)
    _draw(light, _spread(rng, radii), radii, shade)
    found = measure_sizes(_camera(light, rng), 1.0)
    assert found.count == len(radii)
    assert found.d32_m == pytest.approx(_d32(radii), rel=WITHIN)
    assert found.circularity == pytest.approx(1.0, abs=WITHIN)


def test_small_grains_beside_large_ones_are_no_dust():
    """Half of the grains are a third as large; specks of 2 px are dust all the same."""
    rng = np.random.default_rng(2)
    radii = np.repeat([24.0, 8.0, 1.0], [10, 14, 20])
    light = np.full(SIZE[::-1], 210.0)
    _draw(light, _spread(rng, radii), radii, _flat(60.0))
    found = measure_sizes(_camera(light, rng), 1.0)
    assert found.count == 24
    assert found.quantiles_m()[0] == pytest.approx(16.0, rel=WITHIN)
    assert found.d32_m == pytest.approx(_d32(radii[:24]), rel=WITHIN)


def test_single_wrong_pixels_are_no_grains():
    rng = np.random.default_rng(3)
    radii = rng.normal(14.0, 1.0, 24)
    light = np.full(SIZE[::-1], 190.0)
    _draw(light, _spread(rng, radii), radii, _flat(70.0))
    picture = _camera(light, rng)
    chance = rng.random(light.shape)
    picture[chance < 0.02], picture[chance > 0.98] = 0, 255
    found = measure_sizes(picture, 1.0)
    assert found.count == len(radii)
    assert found.d32_m == pytest.approx(_d32(radii), rel=WITHIN)


def _dish(light: np.ndarray) -> None:
    """Lay a bench around a light dish."""
    around = np.full(light.shape, 60.0)
    mask = cv2.ellipse(np.zeros(light.shape), (230, 190), (225, 185), 0, 0, 360, 1.0, -1)
    light[:] = np.where(mask > 0, light, around)


def _ruler(light: np.ndarray) -> None:
    """Lay a white ruler with black ticks into the picture, a little turned."""
    ruler = np.zeros(light.shape)
    ruler[300:350, 20:440] = 245.0
    for k in range(38):
        ruler[300 : 325 if k % 5 == 0 else 315, 30 + 11 * k : 32 + 11 * k] = 15.0
    turn = cv2.getRotationMatrix2D((230, 325), 2.0, 1.0)
    there = cv2.warpAffine((ruler > 0).astype(float), turn, SIZE)
    light[:] = light * (1.0 - there) + cv2.warpAffine(ruler, turn, SIZE)


@pytest.mark.parametrize("surroundings", [_dish, _ruler])
def test_what_lies_around_hides_no_grain(surroundings: Callable[[np.ndarray], None]):
    rng = np.random.default_rng(4)
    radii = rng.normal(11.0, 0.8, 20)
    centres = _spread(rng, radii) * [0.55, 0.5] + [0.22 * SIZE[0], 0.18 * SIZE[1]]
    apart = np.hypot(*(centres[:, None] - centres[None]).transpose(2, 0, 1)) + 99.0 * np.eye(20)
    radii = np.minimum(radii, 0.5 * apart.min(axis=1) - 2.0)
    light = np.full(SIZE[::-1], 190.0)
    surroundings(light)
    _draw(light, centres, radii, _flat(60.0))
    found = measure_sizes(_camera(light, rng), 1.0)
    assert found.count == len(radii)
    assert found.d32_m == pytest.approx(_d32(radii), rel=WITHIN)


def test_a_ruler_as_bright_as_the_grains_is_cut_in_pieces_and_none_counts():
    """Ticks from its upper edge on make it narrow: one piece of the face was counted as a grain."""
    rng = np.random.default_rng(7)
    radii = rng.normal(11.0, 0.6, 20)
    light = np.full((SIZE[1] + 80, SIZE[0]), 40.0)
    below = light[80:]
    _draw(below, _spread(rng, radii), radii, _flat(150.0))
    light[12:52, 14:446] = 145.0
    for k in range(20):
        light[14 : 46 if k % 10 == 0 else 37 if k % 5 == 0 else 30, 32 + 20 * k : 35 + 20 * k] = (
            20.0
        )
    found = measure_sizes(_camera(light, rng, noise=9.0), 1.0)
    assert found.count == len(radii)
    assert found.d32_m == pytest.approx(_d32(radii), rel=WITHIN)


@pytest.mark.parametrize("turn", [0.0, 1.5])
@pytest.mark.parametrize("grain", [165.0, 110.0])
def test_a_ruler_with_ground_behind_it_is_no_grain(grain: float, turn: float):
    """Far brighter than faint grains, from border to border: its pieces were the grains."""
    rng = np.random.default_rng(8)
    radii = rng.normal(9.0, 0.6, 60)
    columns, top = 2 * SIZE[0], 2 * SIZE[1]
    light = np.full((top + 220, columns), 130.0)
    light[top + 20 : top + 160] = 245.0
    for k in range(42):
        deep = 95 if k % 10 == 0 else 70 if k % 5 == 0 else 47
        light[top + 20 : top + 20 + deep, 10 + 22 * k : 12 + 22 * k] = 15.0
    about = cv2.getRotationMatrix2D((0.5 * columns, top + 90.0), turn, 1.0)
    light = cv2.warpAffine(light, about, light.shape[::-1], borderMode=cv2.BORDER_REPLICATE)
    centres = _spread(rng, radii) * [2.0, 2.0]
    _draw(light[:top], centres, radii, _flat(grain))
    found = measure_sizes(_camera(light, rng), 1.0)
    assert found.count == len(radii)
    assert found.d32_m == pytest.approx(_d32(radii), rel=WITHIN)


def _triangle(angle: float, height: float) -> np.ndarray:
    """Return the part of each pixel that a heap covers, its plate at row 330."""
    fine = (np.arange(700 * 3) + 0.5) / 3, (np.arange(400 * 3) + 0.5) / 3
    x, y = np.meshgrid(*fine)
    up = 330.0 - y
    inside = (up > 0) & (up < height - np.abs(x - 350.0) * np.tan(np.radians(angle)))
    return np.asarray(inside.reshape(400, 3, 700, 3).mean(axis=(1, 3)))


def test_a_lamp_beside_the_heap():
    """One spot of light on the wall, a third as bright two hundred pixels away."""
    y, x = np.mgrid[:400, :700].astype(float)
    lamp = 0.35 + 0.65 * np.exp(-((x - 180.0) ** 2 + (y - 90.0) ** 2) / (2 * 200.0**2))
    heap = _triangle(34.0, 170.0)
    light = (np.where(y >= 330, 120.0, 235.0) * (1.0 - heap) + 50.0 * heap) * lamp
    found = measure_heap(_camera(light, np.random.default_rng(5))).repose
    assert found.angle_deg == pytest.approx(34.0, abs=WITHIN_DEG)


def _bent_outline(grain: float) -> np.ndarray:
    """Return columns and heights of a heap 208 px high, upper flanks 11 deg steeper than lower.

    Its surface is smooth, or of grains side by side that lie up to half a diameter off.
    """
    half, rng = 104.0, np.random.default_rng(11)
    upper, lower = (half / np.tan(np.radians(deg)) for deg in (41.0, 30.0))
    corners = np.array([-upper - lower, -upper, 0.0, upper, upper + lower])
    x = np.arange(corners[0], corners[-1])
    z = np.interp(x, corners, half * np.array([0.0, 1.0, 2.0, 1.0, 0.0]))
    if grain:
        at = np.arange(x[0], x[-1], 0.8 * grain)
        off = np.interp(at, x, z) + rng.uniform(-0.5, 0.5, len(at)) * grain
        away = 1.0 - ((x[:, None] - at) / (0.5 * grain)) ** 2
        z = np.max(off + 0.5 * grain * (np.sqrt(np.clip(away, 0.0, 1.0)) - 1.0)
                   - 1e3 * (away < 0.0), axis=1)  # fmt: skip
    return np.column_stack([x - x[0], np.maximum(z, 0.0)])


def test_few_grains_may_bend_a_flank_by_chance():
    """Thirteen grains high, halves of flanks are known to some degrees; a smooth heap is bent."""
    for grain, bent in ((16.0, False), (0.0, True)):
        outline = _bent_outline(grain)
        image = np.where(np.arange(240)[::-1, None] < outline[:, 1], 0, 255).astype(np.uint8)
        repose = fit_flanks(outline, FlankFit())
        with pytest.raises(CaseError, match="no straight flanks") if bent else nullcontext():
            check_heap(repose, image == 0, image)


def _stripes() -> np.ndarray:
    y, x = np.mgrid[:450, :700]
    return np.where((x + y) // 60 % 2, 60.0, 220.0)


def _ellipses() -> np.ndarray:
    light, rng = np.full((450, 700), 190.0), np.random.default_rng(104)
    for _ in range(12):
        at, axes = rng.uniform((0, 0), (700, 450)).astype(int), rng.uniform(20, 150, 2).astype(int)
        cv2.ellipse(light, at.tolist(), axes.tolist(), rng.uniform(0, 180), 0, 360,
                    rng.uniform(0, 255), -1)  # fmt: skip
    return light


@pytest.mark.parametrize("picture", [_stripes, _ellipses])
def test_shapes_that_are_no_heaps(picture: Callable[[], np.ndarray]):
    with pytest.raises(CaseError, match="no heap in the picture"):
        measure_heap(_camera(picture(), np.random.default_rng(6)))
