"""How well an emulator predicts points that it is not shown: numbers and a figure."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from calibrate.emulator.part import Part

__all__ = ["draw_left_out", "quality_of"]

NINETY: Final = 1.645
"""Half width of a 90 % interval in standard errors."""


def quality_of(part: Part) -> dict[str, float | int | str]:
    """Return the quality of one output; every point is left out with all its runs.

    Returns
    -------
    dict
        ``output``: its name. ``Q2``: share of the variance of runs that is predicted; seed noise
        keeps it below 1; nan for an output that never changes. ``z_rms``: root mean square of
        errors in units of their expected size, noise included; 1 is honest. ``inflation``: factor
        on variances for that, the largest of a curve's components. ``n``, ``points``: runs and
        different points. ``noise``: standard deviation of a run about the expected output; root
        mean square over a curve. ``components``: numbers by which it is emulated. ``outliers``:
        runs that were not believed.
    """
    left = part.left_out
    missed = float(np.sum((left.y - left.mean) ** 2))
    scatter = float(np.sum((part.y - part.y.mean(axis=0)) ** 2))
    changes = any(one.form.scale for one in part.processes)
    z = np.array([one.z_rms for one in part.processes])
    believed = np.all([one.runs.believed for one in part.processes], axis=0)
    return {
        "output": part.output.name,
        "Q2": 1.0 - missed / scatter if changes else np.nan,
        "z_rms": float(np.sqrt(np.mean(z**2))),
        "inflation": max(one.inflation for one in part.processes),
        "n": len(part.y),
        "points": len(np.unique(part.inputs.u, axis=0)),
        "noise": float(np.sqrt(np.mean(part.noise))),
        "components": len(part.processes),
        "outliers": int(np.count_nonzero(~believed)),
    }


def draw_left_out(axis: Any, part: Part, colour: str = "C0") -> None:
    """Draw what is predicted of left-out runs, with 90 % intervals, against what they gave.

    Parameters
    ----------
    axis : matplotlib Axes
        Of the caller; gets points, bars and the diagonal, no labels.
    part : Part
    colour : str
        Of the points; outliers are crosses.
    """
    left = part.left_out
    believed = np.all([one.runs.believed for one in part.processes], axis=0)
    bar = NINETY * np.sqrt(left.variance)
    for which, marker in ((believed, "o"), (~believed, "x")):
        axis.errorbar(
            left.y[which].ravel(), left.mean[which].ravel(), yerr=bar[which].ravel(),
            fmt=marker, color=colour, markersize=3, elinewidth=0.7, alpha=0.7,
        )  # fmt: skip
    ends = [float(left.y.min()), float(left.y.max())]
    axis.plot(ends, ends, color="0.5", linewidth=0.8)
