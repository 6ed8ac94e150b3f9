"""Whether the targets of a stage decide its parameters, in words that a report can print."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

import numpy as np

from calibrate.arrays import Array
from calibrate.inference import Interval
from calibrate.significance import shown, significant, weighed
from calibrate.staged.contours import Meeting, contour_lines, meet
from calibrate.staged.optimum import unit_points
from calibrate.staged.problem import StagePosterior
from calibrate.study.schema.targets import Target

__all__ = ["LINES", "Verdict", "judge", "least_squares_sentence"]

LINES: Final = 2
"""Free parameters of a stage whose targets are lines that may cross."""
GRID: Final = 161
APART: Final = 0.05  # of the box, below which two crossings are one
ERRORS: Final = "measurement and surrogate"

Status: TypeAlias = Literal["crossing", "no_crossing", "out_of_reach"]


@dataclass(frozen=True)
class Verdict:
    """What the targets of a stage say together.

    Attributes
    ----------
    status : {"crossing", "no_crossing", "out_of_reach"}
        Of two parameters: every pair of target lines crosses; some pair does not, so that no point
        meets all targets. Of one or many, where targets are no lines: some target is missed at the
        found values by more than the errors explain. Last: one is never reached in the box.
    sentences : tuple of str
        The same in words, with numbers.
    meetings : tuple of Meeting
        Of two parameters.
    """

    status: Status
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
    posterior: StagePosterior,
) -> Verdict:
    """Judge a stage.

    Parameters
    ----------
    targets : sequence of Target
        Targets of the stage.
    measured : (j,) float64
        Their values; of a curve the mean over its levels.
    predict : callable
        Maps (k, d) points of the unit cube to (k, j) predicted values.
    z : sequence of float
        Predicted minus measured at the found values, in standard errors of both together.
    posterior : StagePosterior
        Probability of the parameters.
    """
    fields = predict(unit_points(posterior.size, GRID)).T
    out = [
        _reach(target, field, float(value), score)
        for target, field, value, score in zip(targets, fields, measured, z, strict=True)
        if not field.min() <= value <= field.max()
    ]
    meetings, misses, several = (
        _lines(targets, fields, measured, z) if posterior.size == LINES else ([], [], [])
    )
    if posterior.size == 1:
        several = _places(targets, fields, measured)
    conflict = _conflict(targets, z)
    contradicts = misses if posterior.size == LINES else conflict
    status: Status = "out_of_reach" if out else "no_crossing" if contradicts else "crossing"
    regions = posterior.regions()
    apart = (
        [f"The data allow {regions} separate regions; the intervals span all of them."]
        if regions > 1
        else []
    )
    return Verdict(status, (*out, *misses, *several, *conflict, *apart), tuple(meetings))


def _lines(
    targets: Sequence[Target], fields: Array, measured: Array, z: Sequence[float]
) -> tuple[list[Meeting], list[str], list[str]]:
    """Return how the lines of the targets meet, which do not, and which do so more than once."""
    axis = np.linspace(0.0, 1.0, GRID)
    lines = {
        target.name: contour_lines((axis, axis), field.reshape(GRID, GRID), float(value))
        for target, field, value in zip(targets, fields, measured, strict=True)
    }
    meetings = meet(lines)
    labels = {t.name: t.label for t in targets}
    scores = {t.name: score for t, score in zip(targets, z, strict=True)}
    misses = [_miss(m, labels, scores) for m in meetings if not len(m.points)]
    pairs = meetings if len(targets) == LINES else []
    return meetings, misses, [_several(m, labels) for m in pairs if _apart(m) > 1]


def _places(targets: Sequence[Target], fields: Array, measured: Array) -> list[str]:
    """Say of one parameter where a single target is met more than once."""
    if len(targets) > 1:
        return []
    crossed = int(np.count_nonzero(np.diff(np.sign(fields[0] - measured[0]))))
    if crossed < 2:
        return []
    return [
        f"The curve of '{targets[0].label}' takes the measured value at {crossed} places; the "
        "marked one is the most probable. The intervals span them all as far as the data allow."
    ]


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
        if all(np.linalg.norm(point - other) > APART for other in kept):
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
