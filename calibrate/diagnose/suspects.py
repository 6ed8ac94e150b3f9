"""Every candidate after its own joint fit: how well it stands, and against which rivals."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from calibrate.arrays import Array
from calibrate.diagnose.fit import Fit, Task, ahead, fit
from calibrate.diagnose.problem import Candidate
from calibrate.diagnose.scores import Frame, Noise, draw_noise, frame, imagine, screen
from calibrate.diagnose.stack import Stack


@dataclass(frozen=True)
class Levels:
    """Error rates the verdict works to, and the number of imagined studies.

    Attributes
    ----------
    search : float
        Chance that a candidate gains enough although nothing is hidden.
    residual : float
        Without a name, a misfit less likely than this is called unknown.
    explained : float
        A cause is named only if what it leaves is at least this likely. An error outside the
        library is half explained by whatever candidate resembles it most, so this is stricter.
    rival : float
        A rival stays in the group unless it is less likely than this to lose so clearly.
    draws : int
        Imagined studies.
    """

    search: float = 0.03
    residual: float = 0.01
    explained: float = 0.05
    rival: float = 0.05
    draws: int = 1000


@dataclass(frozen=True)
class Suspect:
    """One candidate after its own joint fit.

    Attributes
    ----------
    candidate : str
    strength : float
        Fitted strength, all parameters refitted.
    gain : float
        Fall of the misfit against the base model: its score at the base fit, or what its own
        joint fit gains if that is more. Far from the truth the score falls short, because the
        base fit has bent the parameters to imitate the cause.
    levels : tuple of float
        Rise of the misfit that bounds its 68 % and 95 % interval: what imagined studies with
        this cause show at the true strength, and never less than chi-square says.
    p_residual : float
        Chance of a residual this large if this candidate is the cause.
    p_rival : float
        Chance that the best candidate would look this much better if this one is the cause; 1
        for the best one itself.
    fitted : Fit
    """

    candidate: str
    strength: float
    gain: float
    levels: tuple[float, float]
    p_residual: float
    p_rival: float
    fitted: Fit


def tail(draws: Array, value: float) -> float:
    """Chance of at least `value`, never zero: the observed case counts as one draw."""
    return float((1 + np.sum(draws >= value)) / (1 + len(draws)))


@dataclass(frozen=True)
class Court:
    """What every step of the verdict needs.

    Attributes
    ----------
    stack : Stack
    base, wide : Fit
        Joint fit of the base model, and the same allowed beyond the runs (extrapolated).
    low, high : ndarray, shape (d,)
        Trusted region.
    levels : Levels
    rng : numpy Generator
    """

    stack: Stack
    base: Fit
    wide: Fit
    low: Array
    high: Array
    levels: Levels
    rng: np.random.Generator

    def task(self, candidate: Candidate) -> Task:
        """Joint fit with one candidate."""
        return Task(self.stack, self.low, self.high, candidate)

    def noise(self, fitted: Fit) -> Noise:
        """Fresh errors of imagined studies."""
        return draw_noise(self.stack, fitted, self.levels.draws, self.rng)


def suspects_of(court: Court, gains: Array) -> tuple[Suspect, ...]:
    """Joint fit of every candidate and how well each stands against the best one."""
    candidates = court.stack.problem.candidates
    here = screen(frame(court.stack, court.base))
    fits = [_best_fit(court, c, float(s)) for c, s in zip(candidates, here.strength, strict=True)]
    order = sorted(range(len(fits)), key=lambda k: fits[k].objective)
    best = order[0]
    rows = []
    for k in order:
        p_residual, levels = _residual_chance(court, fits[k], k)
        lead = ahead(fits[best], fits[k])
        rows.append(
            Suspect(
                candidate=candidates[k].name,
                strength=fits[k].strengths[candidates[k].name],
                gain=max(float(gains[k]), ahead(fits[k], court.base)),
                levels=levels,
                p_residual=p_residual,
                p_rival=1.0 if k == best else _rival_chance(court, fits[k], (k, best), lead),
                fitted=fits[k],
            )
        )
    return tuple(rows)


def _best_fit(court: Court, candidate: Candidate, strength: float) -> Fit:
    """Joint fit with a candidate from several starts; a cause and parameters form a long ridge.

    The base fit has moved the parameters to imitate the cause, so the way back leads from there
    to where the search began.
    """
    task = court.task(candidate)
    sign = 1.0 if strength > 0.0 or candidate.upper > -candidate.lower else -1.0
    middle = 0.5 * (court.low + court.high)
    starts = [
        (court.base.u, strength),
        (court.stack.problem.start, 0.5 * sign * candidate.step),
        (middle, sign * candidate.step),
    ]
    return min((fit(task, u, s) for u, s in starts), key=lambda f: f.objective)


def _residual_chance(court: Court, fitted: Fit, column: int) -> tuple[float, tuple[float, float]]:
    """Chance of a residual this large if the candidate is the cause, and its interval's levels.

    The gain from letting the strength move away from the truth is the likelihood ratio at the
    truth: its quantiles are the levels of the interval.
    """
    here = _only(frame(court.stack, fitted), [column])
    zero = np.zeros(len(court.stack.y))
    imagined = imagine(court.stack, fitted, *_restrict(court, here, fitted, [column]), zero)
    seen, drawn = screen(here), screen(imagined)
    p_residual = tail(drawn.total - drawn.gain[:, 0], float(seen.total - seen.gain[0]))
    level68, level95 = np.quantile(drawn.gain[:, 0], [0.68, 0.95])
    return p_residual, (max(1.0, float(level68)), max(3.841, float(level95)))


def _only(one: Frame, columns: list[int]) -> Frame:
    """Frame with some candidates left."""
    return replace(
        one,
        by_phi=one.by_phi[..., columns],
        lower=one.lower[columns],
        upper=one.upper[columns],
    )


def _restrict(court: Court, here: Frame, fitted: Fit, columns: list[int]) -> tuple[Frame, Noise]:
    noise = court.noise(fitted)
    errors = replace(noise.surrogate, by_phi=noise.surrogate.by_phi[..., columns])
    return here, replace(noise, surrogate=errors)


def _rival_chance(court: Court, fitted: Fit, pair: tuple[int, int], lead: float) -> float:
    """Chance that the best candidate leads by `lead` if the rival is the true cause.

    Works at the base fit, where both enter linearly; the true mean is the rival's.
    """
    rival, _ = pair
    name = court.stack.problem.candidates[rival].name
    here = _only(frame(court.stack, court.base), list(pair))
    strength = fitted.strengths[name]
    shift = here.by_phi[:, 0] * strength
    # The rival's own fit says where the parameters are if it is the truth.
    free = ~court.base.held
    shift = shift + here.by_u @ (fitted.u[free] - court.base.u[free])
    drawn = screen(
        imagine(court.stack, court.base, *_restrict(court, here, court.base, list(pair)), shift)
    )
    return tail(drawn.gain[:, 1] - drawn.gain[:, 0], lead)
