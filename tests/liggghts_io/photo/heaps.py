"""Synthetic photographs of heaps from the side, in colour, whose angles are known.

Drawn with finer pixels and averaged; then comes what a camera adds: blur, uneven light, noise,
whole grey levels, JPEG.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
ColourImage = npt.NDArray[np.uint8]
Colour = tuple[float, float, float]
FINER = 2
FIXED = 16  # parts of a pixel in which cv2 takes coordinates, here with 4 binary digits


@dataclass(frozen=True)
class Pile:
    """A heap on its plate, and how it is seen; lengths in pixels."""

    left: float = 34.0  # deg
    right: float = 34.0
    height: float = 220.0
    size: tuple[int, int] = (1000, 460)  # columns, rows
    middle: float = 0.5  # of the width: where the crest is
    plate: float = 80.0  # of the picture below the plate's upper side; 0: none is seen
    plate_width: float = 1e6
    plate_thickness: float = 1e6
    ground: Colour = (212, 209, 200)
    grain: Colour = (75, 66, 60)
    table: Colour = (140, 140, 145)
    tilt: float = 0.0  # deg, of the camera: the plate falls to the right
    grains: float = 0.0  # diameter of the grains; 0: a smooth flank
    rounded: float = 0.0  # of the height: radius of the crest
    shadow: float = 0.0  # part of the light that a shadow beside the heap takes
    reach: float = 0.0  # on the wall, from the crest, over the right foot's; 0: beside the heap
    slope: float = 0.2
    vignette: float = 0.2
    blur: float = 1.0
    noise: float = 3.0
    texture: float = 0.0  # grey levels of the background's pattern
    funnel: bool = False
    stream: float = 0.0  # width of the grains that still fall from the funnel
    things: tuple[tuple[float, ...], ...] = ()  # left, top, right, bottom, parts of the picture
    spilled: int = 0  # grains that lie apart on the plate
    jpeg: int = 0  # quality; 0: none
    seed: int = 1


def photograph(pile: Pile) -> ColourImage:
    """Return a photograph of a heap: red, green, blue."""
    rng = np.random.default_rng(pile.seed)
    columns, rows = pile.size
    y, x = (np.mgrid[0 : rows * FINER, 0 : columns * FINER] + 0.5) / FINER
    along, up = _in_plate(pile, x, y)
    light = np.empty((*x.shape, 3), dtype=np.float32)
    light[:] = pile.ground
    light += _pattern(x.shape, pile.texture, rng)[:, :, None]
    if pile.plate:
        on_plate = np.abs(along) < 0.5 * pile.plate_width
        light[(up < 0.0) & (up > -pile.plate_thickness) & on_plate] = pile.table
    if pile.funnel:
        light[_funnel(pile, along, up)] = (60, 62, 66)
    if pile.stream:
        light[(np.abs(along) < 0.5 * pile.stream) & (up > 0.5 * pile.height)] = pile.grain
    if pile.shadow:
        dark = (up < 0.9 * _surface(pile, along - 0.25 * pile.height)) & (up > 0.0)
        width = 10.0
        if pile.reach:
            fall = np.tan(np.radians(pile.right)) / pile.reach
            dark, width = (up < pile.height - fall * along) & (along > 0.0) & (up > 0.0), 2.0
        soft = cv2.GaussianBlur(dark.astype(np.float32), (0, 0), width * FINER)
        light *= 1.0 - pile.shadow * soft[:, :, None]
    light[(up < _surface(pile, along) - 0.5 * pile.grains) & (up >= 0.0)] = pile.grain
    if pile.grains:
        _lay_grains(light, pile, rng)
    for place in rng.uniform(-0.48, 0.48, pile.spilled) * columns:
        _disc(light, pile, (place, 3.0), 3.0, np.array(pile.grain))
    width, tall = FINER * pile.size[0], FINER * pile.size[1]
    for left, top, right, bottom in pile.things:
        there = np.s_[
            round(top * tall) : round(bottom * tall), round(left * width) : round(right * width)
        ]
        light[there] = 30.0
    return _camera(light, pile, rng)


def _in_plate(pile: Pile, x: Array, y: Array) -> tuple[Array, Array]:
    """Return positions along the plate, from below the crest, and above it."""
    c, s = np.cos(np.radians(pile.tilt)), np.sin(np.radians(pile.tilt))
    right, down = x - pile.middle * pile.size[0], y - (pile.size[1] - pile.plate)
    return right * c + down * s, right * s - down * c


def _surface(pile: Pile, along: Array) -> Array:
    rise, fall = np.tan(np.radians([pile.left, pile.right]))
    a, b = pile.height + rise * along, pile.height - fall * along
    if not pile.rounded:
        return np.minimum(a, b)
    soft = pile.rounded * pile.height
    return np.asarray(-soft * np.logaddexp(-a / soft, -b / soft))


def _funnel(pile: Pile, along: Array, up: Array) -> npt.NDArray[np.bool_]:
    outlet = 1.3 * pile.height
    pipe = (up > outlet) & (np.abs(along) < 9.0)
    return pipe | ((up > outlet + 20.0) & (np.abs(along) < 9.0 + 0.8 * (up - outlet - 20.0)))


def _lay_grains(light: Array, pile: Pile, rng: np.random.Generator) -> None:
    """Lay grains along the flanks and into the heap; where they lie does not depend on height."""
    radius = 0.5 * pile.grains
    feet = [-pile.height / np.tan(np.radians(pile.left)), 0.0]
    feet[1] = pile.height / np.tan(np.radians(pile.right))
    many = round(1.6 * (feet[1] - feet[0]) / pile.grains)
    along = np.linspace(*feet, many) + rng.uniform(-radius, radius, many)
    up = _surface(pile, along) - radius + rng.uniform(-0.9, 0.5, many) * radius
    inner = rng.uniform(*feet, 10 * many)
    deep = rng.uniform(0.0, 1.0, 10 * many) * _surface(pile, inner) - radius
    for place, above in zip([*inner, *along], [*deep, *up], strict=True):
        if above > radius:
            shade = 1.0 + 0.15 * rng.standard_normal()
            size = radius * rng.uniform(0.85, 1.15)
            _disc(light, pile, (place, above), size, np.clip(np.array(pile.grain) * shade, 0, 255))


def _disc(light: Array, pile: Pile, at: tuple[float, float], radius: float, ink: Array) -> None:
    c, s = np.cos(np.radians(pile.tilt)), np.sin(np.radians(pile.tilt))
    x = pile.middle * pile.size[0] + at[0] * c + at[1] * s
    y = pile.size[1] - pile.plate + at[0] * s - at[1] * c
    middle = (round(x * FINER * FIXED), round(y * FINER * FIXED))
    cv2.circle(
        light, middle, round(radius * FINER * FIXED), ink.astype(float).tolist(), -1, cv2.LINE_8, 4
    )


def _pattern(shape: tuple[int, ...], strength: float, rng: np.random.Generator) -> Array:
    """Return spots and slow waves, as of a wall or a cloth."""
    if not strength:
        return np.zeros(shape)
    spots = cv2.GaussianBlur(rng.standard_normal(shape), (0, 0), 5.0 * FINER)
    waves = np.sin(np.arange(shape[1]) / (23.0 * FINER))
    return np.asarray(strength * (spots / spots.std() + 0.5 * waves))


def _camera(light: Array, pile: Pile, rng: np.random.Generator) -> ColourImage:
    seen = cv2.resize(light, pile.size, interpolation=cv2.INTER_AREA)
    if pile.blur:
        seen = cv2.GaussianBlur(seen, (0, 0), pile.blur)
    rows, columns = seen.shape[:2]
    y, x = np.mgrid[-1.0 : 1.0 : rows * 1j, -1.0 : 1.0 : columns * 1j]
    lamp = (1.0 - 0.5 * pile.slope * (1.0 + x)) * (1.0 - 0.5 * pile.vignette * (x**2 + y**2))
    seen = seen * lamp[:, :, None] + pile.noise * rng.standard_normal(seen.shape)
    pixels = np.clip(np.round(seen), 0, 255).astype(np.uint8)
    return through_jpeg(pixels, pile.jpeg) if pile.jpeg else pixels


def through_jpeg(pixels: ColourImage, quality: int) -> ColourImage:
    """Return what is left of a picture after JPEG of a quality from 1 to 100."""
    _, packed = cv2.imencode(".jpg", pixels[:, :, ::-1], [cv2.IMWRITE_JPEG_QUALITY, quality])
    return np.ascontiguousarray(cv2.imdecode(packed, cv2.IMREAD_COLOR)[:, :, ::-1])
