"""Joint fit of all base parameters, alone or together with one candidate.

Gauss-Newton on the local surrogate with a covariance that follows the point: the error of the
slopes and signatures enters through the surrogate's predictive covariance at the fitted point
(errors in variables), so a badly known signature cannot fit the data for free.

Symbols: x = (u, phi / step), the free coordinates; the last one only with a candidate.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from calibrate.arrays import Array
from calibrate.diagnose.problem import Candidate
from calibrate.diagnose.stack import PRIOR_CENTRE, PRIOR_SD, Stack

_ITERATIONS = 25
_RENEWALS = 5
# Parameters on [0, 1] are compared with errors of 1e-2 and more, misfits with 1.
_TOLERANCE = 1e-4
_SETTLED = 3e-3


@dataclass(frozen=True)
class Fit:
    """Result of one joint fit.

    Attributes
    ----------
    u : ndarray, shape (d,)
        Parameters on [0, 1].
    strengths : mapping
        Candidate -> strength, empty for the base model.
    power : float
        Misfit r^T V^-1 r plus the prior's pull.
    objective : float
        `power` plus log det V: what is compared between models.
    held : ndarray of bool, shape (d,)
        Parameters that sit at their physical limit.
    edge : bool
        Whether a parameter sits at the edge of the trusted region, so that the surrogate must be
        built anew around it.
    u_sd : ndarray, shape (d,)
        Standard deviation of each parameter on [0, 1].
    """

    u: Array
    strengths: Mapping[str, float]
    power: float
    objective: float
    held: Array
    edge: bool
    u_sd: Array


def ahead(one: Fit, other: Fit) -> float:
    """How much better one fit is than another, whichever way of counting says less.

    The likelihood also rewards a point where the surrogate is sure of itself, the misfit alone
    one where it is not; imagined studies, whose covariance stays, know neither.
    """
    return min(other.objective - one.objective, other.power - one.power)


@dataclass(frozen=True)
class Task:
    """What is free in a fit.

    Attributes
    ----------
    stack : Stack
    low, high : ndarray, shape (d,)
        Trusted region, already cut with [0, 1].
    candidate : Candidate, optional
        Its strength is fitted within its limits.
    fixed : mapping
        Candidate -> strength that is switched on and held.
    """

    stack: Stack
    low: Array
    high: Array
    candidate: Candidate | None = None
    fixed: Mapping[str, float] = field(default_factory=dict)

    @property
    def box(self) -> tuple[Array, Array]:
        """Limits of x."""
        if self.candidate is None:
            return self.low, self.high
        step = self.candidate.step
        return (
            np.append(self.low, self.candidate.lower / step),
            np.append(self.high, self.candidate.upper / step),
        )

    @property
    def _column(self) -> int | None:
        """Position of the candidate among those of the problem."""
        if self.candidate is None:
            return None
        return [c.name for c in self.stack.problem.candidates].index(self.candidate.name)

    def split(self, x: Array) -> tuple[Array, dict[str, float]]:
        """Parameters and strengths at x."""
        d = len(self.low)
        on = dict(self.fixed)
        if self.candidate is not None:
            on[self.candidate.name] = float(x[d]) * self.candidate.step
        return x[:d], on

    def covariance(self, x: Array) -> Array:
        """Covariance V at x."""
        return self.stack.covariance(self.stack.linearise(*self.split(x)).surrogate)

    def power(self, x: Array, inverse: Array) -> float:
        """Misfit at x in a given metric V^-1, the prior's pull included."""
        u, on = self.split(x)
        r = self.stack.y - self.stack.mean(u, on)
        return float(r @ inverse @ r) + float(np.sum(((u - PRIOR_CENTRE) / PRIOR_SD) ** 2))

    def newton(self, x: Array, free: Array, inverse: Array) -> tuple[Array, Array]:
        """Gauss-Newton step of x in the metric V^-1 and covariance of its free part."""
        u, on = self.split(x)
        lin = self.stack.slopes(u, on, self._column)
        jac, precision = lin.by_u, np.full(len(u), PRIOR_SD**-2)
        pull = (u - PRIOR_CENTRE) * precision
        if self.candidate is not None:
            jac = np.column_stack([jac, lin.by_phi[:, 0] * self.candidate.step])
            # A whisper of curvature keeps a signature of zero from dividing by zero.
            precision, pull = np.append(precision, 1e-9), np.append(pull, 0.0)
        jac = jac[:, free]
        weighted = inverse @ jac
        spread = np.linalg.inv(jac.T @ weighted + np.diag(precision[free]))
        step = np.zeros(len(x))
        step[free] = spread @ (weighted.T @ (self.stack.y - lin.mean) - pull[free])
        return step, spread


def fit(task: Task, start: Array, strength: float = 0.0) -> Fit:
    """Fit the parameters, and the candidate's strength if the task has one.

    Parameters
    ----------
    start : ndarray, shape (d,)
        First guess of the parameters.
    strength : float
        First guess of the candidate's strength in its own unit.
    """
    low, high = task.box
    guess = start if task.candidate is None else np.append(start, strength / task.candidate.step)
    x = np.clip(guess, low, high)
    # V is held while x moves and then renewed: with a V that may grow as x moves, a fit would
    # run to where the surrogate knows least, or shy away from it.
    for _ in range(_RENEWALS):
        before = x
        x = descend(task, x, np.linalg.inv(task.covariance(x)))
        if float(np.abs(x - before).max()) < _SETTLED:
            break
    return _summary(task, x)


def fit_from(task: Task, starts: Sequence[Array]) -> Fit:
    """Return the joint fit of least misfit from several starts, each of shape (d,).

    The misfit decides, not the likelihood: a base model that may fit where the surrogate is
    unsure gets the benefit of the doubt, and the next runs.
    """
    return min((fit(task, u) for u in starts), key=lambda one: one.power)


def descend(task: Task, x: Array, inverse: Array) -> Array:
    """Minimise the misfit from `x` in a fixed metric V^-1, inside the task's box."""
    low, high = task.box
    value = task.power(x, inverse)
    for _ in range(_ITERATIONS):
        step = _free_step(task, x, inverse)
        trial, better = x, value
        for shrink in (1.0, 0.5, 0.2, 0.05):
            trial = np.clip(x + shrink * step, low, high)
            better = task.power(trial, inverse)
            if better < value:
                break
        else:
            return x
        moved, fell = float(np.abs(trial - x).max()), value - better
        x, value = trial, better
        if moved < _TOLERANCE or fell < _TOLERANCE:
            break
    return x


def _free_step(task: Task, x: Array, inverse: Array) -> Array:
    """Step with coordinates frozen that press against their limit."""
    low, high = task.box
    free = np.ones(len(x), dtype=bool)
    step = np.zeros(len(x))
    for _ in range(len(x)):
        step, _ = task.newton(x, free, inverse)
        stuck = free & (((x <= low) & (step < 0.0)) | ((x >= high) & (step > 0.0)))
        if not stuck.any():
            break
        free &= ~stuck
    return step


def _summary(task: Task, x: Array) -> Fit:
    covariance = task.covariance(x)
    inverse = np.linalg.inv(covariance)
    power = task.power(x, inverse)
    u, on = task.split(x)
    held = (u <= 1e-9) | (u >= 1.0 - 1e-9)
    edge = ((u <= task.low + 1e-9) | (u >= task.high - 1e-9)) & ~held
    free = np.append(~held, np.ones(len(x) - len(u), dtype=bool))
    _, spread = task.newton(x, free, inverse)
    sd = np.zeros(len(x))
    sd[free] = np.sqrt(np.diag(spread))
    objective = power + float(np.linalg.slogdet(covariance)[1])
    return Fit(u, on, power, objective, held, bool(edge.any()), sd[: len(u)])


@dataclass(frozen=True)
class Profile:
    """Misfit along the strength of one candidate, all parameters refitted at each strength.

    Attributes
    ----------
    strengths, excess : ndarray, shape (k,)
        Misfit above its minimum, in the metric of the best fit.
    interval68, interval95 : tuple of float
        Strengths whose misfit lies within the levels above the minimum, cut at the limits.
    """

    strengths: Array
    excess: Array
    interval68: tuple[float, float]
    interval95: tuple[float, float]


def profile(
    task: Task, best: Fit, scale: float, levels: tuple[float, float] = (1.0, 3.841)
) -> Profile:
    """Refit the parameters along the candidate's strength and read off its intervals.

    Parameters
    ----------
    task : Task
        With the candidate.
    best : Fit
        Its joint fit.
    scale : float
        Expected standard deviation of the strength; sets the reach and spacing of the grid.
    levels : pair of float
        Rise of the misfit at the ends of the 68 % and 95 % interval.
    """
    candidate = task.candidate
    if candidate is None:
        msg = "a profile needs a task with a candidate"
        raise ValueError(msg)
    top = best.strengths[candidate.name]
    reach = np.clip(top + scale * np.linspace(-4.0, 4.0, 25), candidate.lower, candidate.upper)
    grid = np.unique(np.concatenate([[candidate.lower, candidate.upper, top], reach]))
    values = np.full(len(grid), np.nan)
    at = int(np.searchsorted(grid, top))
    inverse = np.linalg.inv(task.covariance(np.append(best.u, top / candidate.step)))
    for indices in (range(at, len(grid)), range(at - 1, -1, -1)):
        u = best.u
        for k in indices:
            held = Task(task.stack, task.low, task.high, None, {candidate.name: float(grid[k])})
            u = descend(held, u, inverse)
            values[k] = held.power(u, inverse)
    excess = values - values.min()
    return Profile(grid, excess, _within(grid, excess, levels[0]), _within(grid, excess, levels[1]))


def _within(grid: Array, excess: Array, level: float) -> tuple[float, float]:
    """Outer crossings of `excess` with `level`, by linear interpolation."""
    inside = np.flatnonzero(excess <= level)
    first, last = int(inside[0]), int(inside[-1])

    def cross(a: int, b: int) -> float:
        share = (level - excess[a]) / (excess[b] - excess[a])
        return float(grid[a] + share * (grid[b] - grid[a]))

    low = float(grid[0]) if first == 0 else cross(first, first - 1)
    high = float(grid[-1]) if last == len(grid) - 1 else cross(last, last + 1)
    return low, high
