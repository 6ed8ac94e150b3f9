"""What an emulator refuses to be given."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.emulator.types import Inputs, Output
from calibrate.errors import CalibrationError

__all__ = ["check_enough", "check_inputs", "check_outputs", "check_runs", "fewest_points"]

ROUNDING: Final = 1e-9
"""An input may leave [0, 1] by this much."""
BEYOND: Final = 3
"""Points needed beyond one per input: the mean, and two that can contradict a plane."""


def check_inputs(inputs: Inputs, parameters: int, effects: int) -> None:
    """Refuse inputs of other shapes than an emulator's, or outside [0, 1].

    Raises
    ------
    CalibrationError
    """
    n = len(inputs.u)
    shapes = {
        "u": (inputs.u.shape, (n, parameters)),
        "strengths": (inputs.strengths.shape, (n, effects)),
        "seeds": (inputs.seeds.shape, (n,)),
    }
    for name, (found, wanted) in shapes.items():
        if found != wanted:
            msg = f"emulator: {name} has shape {found}; give {wanted}"
            raise CalibrationError(msg)
    if n and not (
        inputs.u.min(initial=0.0) >= -ROUNDING and inputs.u.max(initial=0.0) <= 1 + ROUNDING
    ):
        inside = (inputs.u >= -ROUNDING) & (inputs.u <= 1.0 + ROUNDING)  # False for nan too
        row, column = np.argwhere(~inside)[0]
        msg = (
            f"emulator: input {column} of row {row} is {inputs.u[row, column]:g}, outside the "
            "range 0 to 1 that its runs cover; widen the parameter's range and run more"
        )
        raise CalibrationError(msg)
    if not np.isfinite(inputs.strengths).all():
        row, column = np.argwhere(~np.isfinite(inputs.strengths))[0]
        msg = f"emulator: strength of effect {column} in row {row} is not a number"
        raise CalibrationError(msg)


def check_outputs(outputs: Sequence[Output], width: int) -> None:
    """Refuse outputs that do not share the columns of y among them.

    Raises
    ------
    CalibrationError
    """
    used = [k for one in outputs for k in range(width)[one.columns]]
    if sorted(used) != list(range(width)) or not all(range(width)[o.columns] for o in outputs):
        msg = (
            f"emulator: outputs {[o.name for o in outputs]} name the columns {used}; "
            f"give each of the {width} columns of y to one output"
        )
        raise CalibrationError(msg)


def check_runs(inputs: Inputs, y: Array, width: int) -> None:
    """Refuse outputs of other shape, and values that are infinite.

    Raises
    ------
    CalibrationError
    """
    if y.shape != (len(inputs), width):
        msg = f"emulator: y has shape {y.shape}; give {(len(inputs), width)}"
        raise CalibrationError(msg)
    if np.isinf(y).any():
        row, column = np.argwhere(np.isinf(y))[0]
        msg = f"emulator: y is infinite in row {row}, column {column}; a failed run is nan"
        raise CalibrationError(msg)


def fewest_points(inputs: int) -> int:
    """Return at how many different points an emulator of so many inputs has to be trained."""
    return inputs + BEYOND


def check_enough(name: str, u: Array, tried: int) -> None:
    """Refuse to train an output on too few points.

    Parameters
    ----------
    name : str
        Of the output.
    u : (n, d) float64
        Runs that went well.
    tried : int
        Runs that were made.

    Raises
    ------
    CalibrationError
    """
    points, needed = len(np.unique(u, axis=0)), fewest_points(u.shape[1])
    if points < needed:
        msg = (
            f"output '{name}': {len(u)} of {tried} runs gave a value, at {points} different "
            f"points; an emulator of {u.shape[1]} parameters needs at least {needed} and "
            f"is good from about {10 * u.shape[1]}: make more runs or free fewer parameters"
        )
        raise CalibrationError(msg)
