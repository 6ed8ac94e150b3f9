"""Grains within a box, in the last frame or in a part of the frames."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np
from pydantic import BaseModel, ConfigDict

from liggghts_io.measure.dumps import Frame
from liggghts_io.measure.extract.base import Amount, Extractor, Number, Options, Part
from liggghts_io.measure.extract.run import Run

SIZED: Final = ("radius",)


class Box(BaseModel):
    """A box along the axes; a side that is left out is open.

    Attributes
    ----------
    x, y, z : (float or str, float or str)
        From and to [m], numbers or formulas.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    x: tuple[Amount, Amount] | None = None
    y: tuple[Amount, Amount] | None = None
    z: tuple[Amount, Amount] | None = None

    def formulas(self) -> tuple[str, ...]:
        """Return the formulas among the limits."""
        pairs = (self.x, self.y, self.z)
        return tuple(one for pair in pairs for one in pair or () if isinstance(one, str))

    def side(self, axis: str, run: Run) -> tuple[float, float]:
        """Return from and to of an axis [m]."""
        pair = getattr(self, axis)
        return (-np.inf, np.inf) if pair is None else (run.amount(pair[0]), run.amount(pair[1]))


class OfGrains(Options):
    """What extractors that look at grains have in common.

    Attributes
    ----------
    dump : str
        Name of the dump; empty for the one named "frames", or the only one.
    part : (float, float), optional
        Part of the frames over which a mean is taken; without it, the last frame.
    box : Box
    slower_than : float, optional
        Only grains below this speed [m/s], to leave out those in flight.
    """

    dump: str = ""
    part: Part | None = None
    box: Box = Box()
    slower_than: Number | None = None

    def formulas(self) -> tuple[str, ...]:
        """Return the formulas among the limits of the box."""
        return self.box.formulas()

    def frames_of(self, run: Run, needed: tuple[str, ...]) -> Iterator[Frame]:
        """Yield the frames, each with the grains that are asked for."""
        speeds = () if self.slower_than is None else ("vx", "vy", "vz")
        for frame in run.frames(self.dump, self.part, (*needed, *speeds)):
            yield self.seen(frame, run)

    def seen(self, frame: Frame, run: Run) -> Frame:
        """Return the grains of a frame that are asked for."""
        keep = np.ones(frame.count, dtype=np.bool_)
        for axis in "xyz":
            low, high = self.box.side(axis, run)
            keep &= (frame.columns[axis] >= low) & (frame.columns[axis] <= high)
        if self.slower_than is not None:
            keep &= frame.speeds < self.slower_than
        return Frame(frame.step, {name: one[keep] for name, one in frame.columns.items()})


class GrainNumber(OfGrains, Extractor):
    """A number of the grains in each frame; the observable is its mean over the frames."""
