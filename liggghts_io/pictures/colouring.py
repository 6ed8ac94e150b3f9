"""What the colours of grains say: speed, height, type or size."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from liggghts_io.errors import CaseError, nearest
from liggghts_io.measure.dumps import Frame

FloatArray = npt.NDArray[np.float64]
SPEED: Final = "speed"
TYPE: Final = "type"
COLOURS: Final = (SPEED, "height", TYPE, "size")

_MM: Final = 1e3
_LEAST_SPEED: Final = 1e-3  # m/s, so that grains at rest do not stretch the colours over rounding
_SAME: Final = 1e-6  # sizes that differ by less, as a part of them, are one
_VELOCITY: Final = ("vx", "vy", "vz")
_NEEDED: Final = {SPEED: _VELOCITY, "height": ("z",), TYPE: (TYPE,), "size": ("radius",)}
_WORDS: Final = {SPEED: "speed (m/s)", "height": "height z (mm)", "size": "diameter (mm)"}
_MAPS: Final = {SPEED: "YlGnBu", "height": "viridis", "size": "viridis"}
_PALE: Final = 0.16  # of the speed colours are left out at the pale end: they would be white
_STEPS: Final = 256
_TYPES: Final = (
    "#d9b573", "#3b7ea1", "#c8553d", "#6a994e", "#8e6c8a", "#e9c46a", "#264653", "#9d9d9d",
)  # fmt: skip


@dataclass(frozen=True)
class Colouring:
    """What colours say, the same for all frames of a film.

    Attributes
    ----------
    by : str
        "speed", "height", "type" or "size".
    low, high : float
        Ends of the colours [m/s or mm].
    types : tuple of int
        Types that occur, in their order.
    """

    by: str
    low: float
    high: float
    types: tuple[int, ...] = ()

    @property
    def label(self) -> str:
        """Words beside the colours."""
        return _WORDS.get(self.by, self.by)

    @property
    def is_bar(self) -> bool:
        """Whether the colours form a bar, else one patch for each kind of grain."""
        return self.by != TYPE and self.high - self.low > _SAME * max(abs(self.high), 1e-12)

    @property
    def scale(self) -> Any:
        """Colour map of matplotlib."""
        from matplotlib import colormaps
        from matplotlib.colors import ListedColormap

        start = _PALE if self.by == SPEED else 0.0
        return ListedColormap(colormaps[_MAPS[self.by]](np.linspace(start, 1.0, _STEPS)))

    @property
    def patches(self) -> list[tuple[str, str]]:
        """Colour and words of each kind of grain, where the colours form no bar."""
        if self.by == TYPE:
            return [(_of_type(one), f"type {one}") for one in self.types]
        return [(_TYPES[0], f"{self.label.partition(' (')[0]} {self.high:.4g} mm")]

    def of(self, frame: Frame) -> npt.NDArray[np.uint8]:
        """Return the colours of the grains, shape (n, 3)."""
        from matplotlib.colors import to_rgb

        if self.is_bar:
            part = (values_of(frame, self.by) - self.low) / (self.high - self.low)
            colours = self.scale(np.clip(part, 0.0, 1.0))[:, :3]
        elif self.by == TYPE:
            table = {one: to_rgb(_of_type(one)) for one in self.types}
            colours = np.array([table[int(one)] for one in frame.columns[TYPE]]).reshape(-1, 3)
        else:
            colours = np.tile(to_rgb(_TYPES[0]), (frame.count, 1))
        return np.asarray(np.round(255.0 * colours), dtype=np.uint8)


def _of_type(one: int) -> str:
    return _TYPES[(one - 1) % len(_TYPES)]


def checked_colour(by: str) -> str:
    """Return what colours are to say.

    Raises
    ------
    CaseError
        For something unknown, with the nearest word.
    """
    if by not in COLOURS:
        msg = f"colour {by!r}: grains are not coloured by that{nearest(by, COLOURS)}"
        raise CaseError(msg)
    return by


def values_of(frame: Frame, by: str) -> FloatArray:
    """Return what the colours of a bar say of each grain, shape (n,) [m/s or mm].

    Raises
    ------
    CaseError
        If the dump does not hold it.
    """
    missing = [name for name in _NEEDED[by] if name not in frame.columns]
    if missing:
        there = [word for word in COLOURS if all(one in frame.columns for one in _NEEDED[word])]
        msg = f"colour {by}: the dump has no column {missing[0]}; choose {' or '.join(there)}"
        raise CaseError(msg)
    if by == SPEED:
        return frame.speeds
    if by == TYPE:
        return frame.columns[TYPE]
    return _MM * (frame.columns["z"] if by == "height" else 2.0 * frame.columns["radius"])


def colouring_of(frames: Iterable[Frame], by: str, inside: Any = None) -> Colouring:
    """Return what colours say, with ends that hold all grains of some frames.

    Parameters
    ----------
    frames : iterable of Frame
    by : str
    inside : callable, optional
        Frame to the grains (n,) bool that count, such as those in the picture.

    Raises
    ------
    CaseError
        If a dump does not hold what colours are to say.
    """
    low, high = np.inf, -np.inf
    types: set[int] = set()
    for frame in frames:
        values = values_of(frame, by)
        if by == TYPE:
            types |= {int(one) for one in np.unique(values)}
            continue
        kept = values if inside is None else values[inside(frame)]
        low, high = min(low, kept.min(initial=low)), max(high, kept.max(initial=high))
    if by == SPEED:
        return Colouring(by, 0.0, max(float(high), _LEAST_SPEED))
    if by == TYPE:
        return Colouring(by, 0.0, 0.0, tuple(sorted(types)))
    return Colouring(by, float(low), float(high))
