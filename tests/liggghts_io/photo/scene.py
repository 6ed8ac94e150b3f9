"""Synthetic photographs of grains from above, whose truth is known.

Grains are ellipses, drawn with eight times finer pixels and averaged, so that the picture of a
grain has the area of the grain. Then comes what a camera adds, in its order: blur, uneven light,
noise, rounding to whole grey levels.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import cv2
import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

Array = npt.NDArray[np.float64]
FINER = 8
TOUCH = 0.15  # px that touching grains overlap: they are one blob at every resolution
TRIES = 4000


@dataclass(frozen=True)
class Scene:
    """What lies under the camera, and how it is seen."""

    count: int = 120
    diameter: float = 30.0  # px, mean
    spread: float = 0.08  # standard deviation of the diameters over their mean
    aspect: float = 1.25  # longest axis over shortest, from 1 to this
    touching: float = 0.3  # share of grains that are laid against another one
    cover: float = 0.25  # share of the picture that grains cover
    ground: float = 200.0  # grey levels
    grain: float = 60.0
    grain_spread: float = 0.05  # of the contrast, from grain to grain
    highlight: float = 0.0  # brightness of a reflection on every grain, parts of the contrast
    blur: float = 0.8  # px
    noise: float = 3.0  # grey levels
    slope: float = 0.2  # light falls by this part from one side to the other
    vignette: float = 0.2  # and by this part from the middle to the corners
    texture: float = 0.0  # grey levels of the ground's own pattern
    tracer: bool = False
    ruler: bool = False
    dust: int = 0
    scratches: int = 0
    seed: int = 1


@dataclass(frozen=True)
class Truth:
    """The grains that are whole in the picture."""

    centres: Array  # (n, 2)
    axes: Array  # (n, 2) half axes [px]
    turns: Array  # (n,) rad
    diameters: Array = field(init=False)
    circularities: Array = field(init=False)

    def __post_init__(self) -> None:
        """Derive equations 1 and 2 of the paper for ellipses."""
        a, b = self.axes.T
        h = ((a - b) / (a + b)) ** 2
        around = np.pi * (a + b) * (1.0 + 3.0 * h / (10.0 + np.sqrt(4.0 - 3.0 * h)))  # Ramanujan
        diameters = 2.0 * np.sqrt(a * b)
        object.__setattr__(self, "diameters", diameters)
        object.__setattr__(self, "circularities", np.pi * diameters / around)

    @property
    def d32(self) -> float:
        """Sauter diameter, equation 3 [px]."""
        return float(np.sum(self.diameters**3) / np.sum(self.diameters**2))

    def quantile(self, part: float) -> float:
        """Return a number quantile of the diameters [px]."""
        return float(np.quantile(self.diameters, part))

    @property
    def circularity(self) -> float:
        """Mean circularity."""
        return float(self.circularities.mean())


def photograph(scene: Scene) -> tuple[npt.NDArray[np.uint8], Truth]:
    """Return a grey photograph and what is on it."""
    rng = np.random.default_rng(scene.seed)
    axes = _half_axes(scene, rng)
    free = np.pi * float(np.sum(axes[:, 0] * axes[:, 1])) / scene.cover
    rows = round(np.sqrt(free / 1.5)) + 4
    columns = round(1.5 * rows)
    strip = round(max(30.0, 0.12 * rows)) if scene.ruler else 0
    centres, turns = _places(scene, axes, (rows, columns), rng)
    shape = (rows + strip, columns)
    light = np.full(shape, float(scene.ground))
    light += _pattern(shape, scene.texture, rng)
    contrast = scene.grain - scene.ground
    levels = scene.grain + contrast * scene.grain_spread * rng.standard_normal(len(axes))
    if scene.tracer:
        levels[rng.integers(len(axes))] = 250.0 if contrast < 0 else 5.0
    for centre, half, turn, level in zip(centres, axes, turns, levels, strict=True):
        _draw(light, centre, half, turn, level)
        if scene.highlight:
            shine = centre - 0.3 * half.min()
            _draw(light, shine, 0.2 * half, turn, level - scene.highlight * contrast)
    _add_dirt(light, scene, rng)
    if scene.ruler:
        draw_ruler(light[rows:], scene.diameter)
    dark_tracer = np.ones(len(axes), dtype=bool)
    if scene.tracer:
        dark_tracer = np.abs(levels - scene.grain) < 0.5 * abs(contrast)
    return through_the_camera(light, scene, rng), Truth(
        centres[dark_tracer], axes[dark_tracer], turns[dark_tracer]
    )


def through_the_camera(
    light: Array, scene: Scene, rng: np.random.Generator
) -> npt.NDArray[np.uint8]:
    """Return what a camera makes of the light: blur, uneven light, noise, whole grey levels."""
    rows, columns = light.shape
    seen = cv2.GaussianBlur(light, (0, 0), scene.blur) if scene.blur else light
    y, x = np.mgrid[-1.0 : 1.0 : rows * 1j, -1.0 : 1.0 : columns * 1j]
    seen = (
        seen * (1.0 - 0.5 * scene.slope * (1.0 + x)) * (1.0 - 0.5 * scene.vignette * (x**2 + y**2))
    )
    seen = seen + scene.noise * rng.standard_normal(seen.shape)
    return np.clip(np.round(seen), 0, 255).astype(np.uint8)


def _half_axes(scene: Scene, rng: np.random.Generator) -> Array:
    diameters = scene.diameter * np.exp(scene.spread * rng.standard_normal(scene.count))
    aspects = rng.uniform(1.0, scene.aspect, scene.count)
    return 0.5 * diameters[:, None] * np.column_stack([np.sqrt(aspects), 1.0 / np.sqrt(aspects)])


def _rim(half: Array, turn: float) -> Array:
    t = np.linspace(0.0, 2.0 * np.pi, 72, endpoint=False)
    c, s = np.cos(turn), np.sin(turn)
    return np.column_stack([half[0] * np.cos(t), half[1] * np.sin(t)]) @ np.array([[c, s], [-s, c]])


def _inside(points: Array, half: Array, turn: float, grow: float) -> Array:
    c, s = np.cos(turn), np.sin(turn)
    local = points @ np.array([[c, -s], [s, c]])
    return np.sum((local / (half + grow)) ** 2, axis=1) < 1.0


class _Table:
    """Grains that lie already, and whether a further one would overlap them."""

    def __init__(self, shape: tuple[int, int], longest: float) -> None:
        self.shape, self.longest = shape, longest
        self.centres: list[Array] = []
        self.halves: list[Array] = []
        self.turns: list[float] = []

    def fits(self, centre: Array, half: Array, turn: float, gap: float) -> bool:
        rim = _rim(half, turn)
        low, high = (centre + rim).min(axis=0), (centre + rim).max(axis=0)
        if low.min() < 3.0 or high[0] > self.shape[1] - 3.0 or high[1] > self.shape[0] - 3.0:
            return False
        for k in self.near(centre):
            away = centre - self.centres[k]
            if _inside(away + rim, self.halves[k], self.turns[k], gap).any():
                return False
            if _inside(_rim(self.halves[k], self.turns[k]) - away, half, turn, gap).any():
                return False
        return True

    def near(self, centre: Array) -> npt.NDArray[np.int64]:
        if not self.centres:
            return np.empty(0, dtype=np.int64)
        away = np.linalg.norm(np.array(self.centres) - centre, axis=1)
        return np.flatnonzero(away < 2.2 * self.longest)

    def add(self, centre: Array, half: Array, turn: float) -> None:
        self.centres.append(centre)
        self.halves.append(half)
        self.turns.append(turn)


def _places(
    scene: Scene, axes: Array, shape: tuple[int, int], rng: np.random.Generator
) -> tuple[Array, Array]:
    table = _Table(shape, float(axes.max()))
    gap = max(2.0, 3.0 * scene.blur)
    for half in axes:
        touch = bool(table.centres) and rng.random() < scene.touching
        for tried in range(TRIES):
            turn = float(rng.uniform(0.0, np.pi))
            if touch and tried < TRIES // 2:
                centre = _against(table, half, turn, rng)
            else:
                centre = rng.uniform(half.max() + 3.0, np.array(shape[::-1]) - half.max() - 3.0)
            if table.fits(centre, half, turn, -TOUCH if touch and tried < TRIES // 2 else gap):
                break
        else:
            msg = "the picture is too small for so many grains"
            raise ValueError(msg)
        table.add(centre, half, turn)
    return np.array(table.centres), np.array(table.turns)


def _against(table: _Table, half: Array, turn: float, rng: np.random.Generator) -> Array:
    """Return a centre that lets the grain touch one that lies there, from a random side."""
    k = int(rng.integers(len(table.centres)))
    way = float(rng.uniform(0.0, 2.0 * np.pi))
    step = np.array([np.cos(way), np.sin(way)])
    low, high = 0.0, 3.0 * table.longest
    rim = _rim(half, turn)
    for _ in range(16):
        middle = 0.5 * (low + high)
        apart = not _inside(middle * step + rim, table.halves[k], table.turns[k], -TOUCH).any()
        low, high = (low, middle) if apart else (middle, high)
    return np.asarray(table.centres[k] + high * step)


def _draw(light: Array, centre: Array, half: Array, turn: float, level: float) -> None:
    """Lay an ellipse into the light, its edge averaged over fine pixels."""
    reach = int(np.ceil(half.max())) + 2
    x0, y0 = int(centre[0]) - reach, int(centre[1]) - reach
    fine = (np.arange((2 * reach + 1) * FINER) + 0.5) / FINER
    x, y = np.meshgrid(x0 + fine - centre[0], y0 + fine - centre[1])
    c, s = np.cos(turn), np.sin(turn)
    inside = ((c * x + s * y) / half[0]) ** 2 + ((c * y - s * x) / half[1]) ** 2 <= 1.0
    size = 2 * reach + 1
    part = inside.reshape(size, FINER, size, FINER).mean(axis=(1, 3))
    rows, columns = light.shape
    top, left = max(0, -y0), max(0, -x0)
    bottom, right = min(size, rows - y0), min(size, columns - x0)
    if top >= bottom or left >= right:
        return
    view = light[y0 + top : y0 + bottom, x0 + left : x0 + right]
    share = part[top:bottom, left:right]
    view += share * (level - view)


def _pattern(shape: tuple[int, int], strength: float, rng: np.random.Generator) -> Array:
    """Return an irregular pattern of a few pixels, as cardboard has."""
    if not strength:
        return np.zeros(shape)
    rough = cv2.GaussianBlur(rng.standard_normal(shape), (0, 0), sigmaX=6.0, sigmaY=2.0)
    return np.asarray(strength * rough / rough.std())


def _add_dirt(light: Array, scene: Scene, rng: np.random.Generator) -> None:
    rows, columns = light.shape
    for _ in range(scene.dust):
        half = np.full(2, 0.09 * scene.diameter) * rng.uniform(0.5, 1.0)
        centre = rng.uniform(5.0, np.array([columns, rows]) - 5.0)
        _draw(light, centre, np.maximum(half, 0.7), 0.0, scene.grain)
    for _ in range(scene.scratches):
        centre = rng.uniform(5.0, np.array([columns, rows]) - 5.0)
        half = np.array([2.0 * scene.diameter, max(0.6, 0.04 * scene.diameter)])
        _draw(light, centre, half, float(rng.uniform(0.0, np.pi)), scene.grain)


def draw_ruler(strip: Array, spacing: float) -> None:
    """Draw a white ruler with dark ticks and figures into the lower part of a picture."""
    rows, columns = strip.shape
    strip[round(0.15 * rows) :] = 245.0
    wide = max(1.0, 0.05 * spacing)
    for k, x in enumerate(np.arange(0.5 * spacing, columns - wide, spacing)):
        length = (0.55 if k % 10 == 0 else 0.42 if k % 5 == 0 else 0.3) * rows
        y0 = round(0.15 * rows)
        strip[y0 : y0 + round(length), round(x) : round(x + wide)] = 20.0
        if k % 10 == 0:
            canvas = strip.astype(np.uint8)
            cv2.putText(
                canvas, str(k // 10), (round(x) + 4, rows - 4), cv2.FONT_HERSHEY_SIMPLEX,
                0.01 * rows, 20.0, 1, cv2.LINE_AA,
            )  # fmt: skip
            strip[:] = canvas


def crowd(points: Array, reach: float) -> float:
    """Return the mean number of neighbours within a distance, to see how clustered grains are."""
    tree = cKDTree(points)
    return float(np.mean([len(found) - 1 for found in tree.query_ball_point(points, reach)]))


def grains_in_rows() -> npt.NDArray[np.uint8]:
    """Return a picture of equal grains, one each 52 px to both sides."""
    grey = np.full((400, 620), 200.0, dtype=np.float32)
    for middle in [(x, y) for y in range(60, 360, 52) for x in range(40, 600, 52)]:
        cv2.circle(grey, middle, 13, 60.0, -1, cv2.LINE_AA)
    picture = np.repeat(cv2.GaussianBlur(grey, (0, 0), 0.8)[:, :, None], 3, axis=2)
    return np.asarray(picture.round().astype(np.uint8))
