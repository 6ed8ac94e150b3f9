"""Whether the targets of a stage decide its parameters, in words that a report can print."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from calibrate.arrays import Array
from calibrate.staged.contours import Meeting, contour_lines, meet
from calibrate.staged.posterior import Interval, Posterior
from calibrate.staged.significance import shown, significant, weighed
from calibrate.study.schema.targets import Target

__all__ = ["Verdict", "judge", "least_squares_sentence"]

GRID = 161
ERRORS = "measurement and surrogate"


@dataclass(frozen=True)
class Verdict:
    """What the contour lines of a stage say.

    Attributes
    ----------
    status : {"crossing", "no_crossing", "out_of_reach"}
        Every pair of target lines crosses; some pair does not, so that no point meets all
        targets; some target is never reached in the box.
    sentences : tuple of str
        The same in words, with numbers.
    meetings : tuple of Meeting
    """

    status: Literal["crossing", "no_crossing", "out_of_reach"]
    sentences: tuple[str, ...]
    meetings: tuple[Meeting, ...]

    @property
    def is_point(self) -> bool:
        """Whether the value found may be read as a solution: one that meets all targets."""
        return self.status == "crossing"


def judge(
    targets: Sequence[Target],
    measured: Array,
    predict: Callable[[Array], Array],
    z: Sequence[float],
    posterior: Posterior,
) -> Verdict:
    """Judge a stage.

    Parameters
    ----------
    targets : sequence of Target
        Targets of the stage.
    measured : (j,) float64
        Their values.
    predict : callable
        Maps (k, 2) points of the unit square to (k, j) predicted values.
    z : sequence of float
        Predicted minus measured at the found values, in standard errors of both together.
    posterior : Posterior
        Probability of the parameters.
    """
    axis = np.linspace(0.0, 1.0, GRID)
    points = np.stack(np.meshgrid(axis, axis, indexing="ij"), axis=-1).reshape(-1, 2)
    fields = predict(points).T.reshape(len(targets), GRID, GRID)
    lines, sentences = {}, []
    for target, field, value, score in zip(targets, fields, measured, z, strict=True):
        lines[target.name] = contour_lines((axis, axis), field, float(value))
        if not lines[target.name]:
            sentences.append(_reach(target, field, float(value), score))
    unreachable = bool(sentences)
    meetings = meet(lines)
    labels = {t.name: t.label for t in targets}
    scores = {t.name: score for t, score in zip(targets, z, strict=True)}
    sentences += [_miss(m, labels, scores) for m in meetings if not len(m.points)]
    status: Literal["crossing", "no_crossing", "out_of_reach"] = "crossing"
    if sentences:
        status = "out_of_reach" if unreachable else "no_crossing"
    sentences += [_several(m, labels) for m in meetings if len(targets) == 2 and _apart(m) > 1]
    sentences += _conflict(targets, z)
    regions = posterior.regions()
    if regions > 1:
        sentences.append(
            f"The data allow {regions} separate regions; the intervals span all of them."
        )
    return Verdict(status, tuple(sentences), tuple(meetings))


def _reach(target: Target, field: Array, value: float, z: float) -> str:
    low, high = float(field.min()), float(field.max())
    side, edge = ("above", high) if value > high else ("below", low)
    return (
        f"Out of reach: {target.label} was measured {value:.4g} {target.simulated_unit}, {side} "
        f"everything simulated in the box ({low:.4g} to {high:.4g}), a gap of "
        f"{abs(value - edge):.2g} {target.simulated_unit} or more; at the marked point "
        f"{weighed(z, errors=ERRORS)}."
    )


def _miss(meeting: Meeting, labels: dict[str, str], scores: dict[str, float]) -> str:
    first, second = (labels[name] for name in meeting.names)
    z = [scores[name] for name in meeting.names]
    return (
        f"The lines of '{first}' and '{second}' do not cross, so no point meets both; they come "
        f"within {100 * meeting.gap:.1f} % of the box. At the marked point the surrogates are off "
        f"by {weighed(*z, errors=ERRORS)}."
    )


def _apart(meeting: Meeting) -> int:
    """Return how many crossings lie apart from each other by more than a twentieth of the box."""
    kept: list[Array] = []
    for point in meeting.points:
        if all(np.linalg.norm(point - other) > 0.05 for other in kept):
            kept.append(point)
    return len(kept)


def _several(meeting: Meeting, labels: dict[str, str]) -> str:
    first, second = (labels[name] for name in meeting.names)
    return (
        f"The lines of '{first}' and '{second}' cross at {_apart(meeting)} places; the marked "
        "point is the most probable. The intervals span them all as far as the data allow."
    )


def _conflict(targets: Sequence[Target], z: Sequence[float]) -> list[str]:
    worst = int(np.argmax(np.abs(z)))
    if not significant(z[worst]):
        return []
    return [
        f"At the marked point {targets[worst].label} is missed by z = {shown(z[worst])}, more than "
        f"the errors of {ERRORS} explain: the model cannot meet all targets of this stage at once."
    ]


def least_squares_sentence(
    point: Mapping[str, float], intervals: Mapping[str, Interval], share: float
) -> list[str]:
    """Say where the paper's point lies when it is outside an interval, and why it may be.

    Parameters
    ----------
    point : mapping
        Parameter to its value at the minimum of eq. 18.
    intervals : mapping
        Parameter to the interval of the result.
    share : float
        Probability that the intervals hold.
    """
    outside = [
        f"{name} ({intervals[name].low:.3f} to {intervals[name].high:.3f})"
        for name, value in point.items()
        if not intervals[name].low <= value <= intervals[name].high
    ]
    if not outside:
        return []
    values = ", ".join(f"{name} = {value:.3f}" for name, value in point.items())
    return [
        f"The least squares of relative residuals (eq. 18 of the paper) lie at {values}, outside "
        f"the {100 * share:.0f} % interval of {' and '.join(outside)}: they weigh all targets "
        "alike, while value and interval weigh each by its errors."
    ]
