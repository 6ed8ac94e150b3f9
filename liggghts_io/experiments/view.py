"""How a case of an experiment is drawn, and what is written on its picture."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from liggghts_io.experiments.setup import Setup
from liggghts_io.measure.dumps import Frame


@dataclass(frozen=True)
class Notes:
    """What is written on a picture of a case.

    Positions are those of the apparatus, seen from the side: x to the right, z up.

    Attributes
    ----------
    title : str
    lines : tuple of (n, 2) float64
        Lines, such as fitted flanks: x and z of their points [m].
    labels : tuple of (float, float, str)
        x and z [m] of the middle of a text, and the text.
    """

    title: str = ""
    lines: tuple[npt.NDArray[np.float64], ...] = ()
    labels: tuple[tuple[float, float, str], ...] = ()


def no_notes(_frame: Frame, _setup: Setup, _observables: Mapping[str, float]) -> Notes:
    """Return nothing: a picture without words."""
    return Notes()


def whole_run(_setup: Setup) -> float:
    """Return 1: the last frame is the one that shows most."""
    return 1.0


@dataclass(frozen=True)
class View:
    """How a case of an experiment is drawn: from the side, x to the right and z up.

    Attributes
    ----------
    solid : Mapping[str, float]
        Opacity of every mesh that is drawn; meshes left out only count grains.
    at : callable
        Setup to the part of the run whose frame is drawn where nobody asks for another.
    window : callable, optional
        Setup to what the picture holds: left, right, bottom and top [m]; without it, all grains
        and meshes.
    notes : callable
        Frame, Setup and observables, empty where none are known, to what is written on the picture.
    """

    solid: Mapping[str, float]
    at: Callable[[Setup], float] = whole_run
    window: Callable[[Setup], tuple[float, float, float, float]] | None = None
    notes: Callable[[Frame, Setup, Mapping[str, float]], Notes] = no_notes
