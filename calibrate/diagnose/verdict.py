"""The verdict: nothing, one named cause, a group, or unknown, with calibrated error rates.

Every threshold comes from imagined repetitions of the whole study (parametric bootstrap with
refit): measurement errors as uncertain as their repeats make them, surrogate errors of value,
slopes and signatures, and the search over all candidates.

1. Does the best candidate gain more than it would without any effect? (`p_search`)
2. Does it leave a residual that its own model can explain? (`p_residual` above 1 %)
3. Which rivals would, if true, let it look this much better? They stay in the group.
4. If no candidate gains enough, is the misfit itself too large? Then the cause is unknown.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from calibrate.diagnose.fit import Fit, Profile, Task, fit, profile
from calibrate.diagnose.problem import Array, Candidate
from calibrate.diagnose.screen import Frame, Noise, draw_noise, frame, imagine, screen
from calibrate.diagnose.stack import Stack

# Candidates get their own joint fit when the misfit or the best score is at all remarkable.
_LOOK_MISFIT = 0.05
_LOOK_SCORE = 0.3
# How far behind (in -2 log likelihood) a fit stopped at the edge of the runs may be and still be
# suspected: about two and a half standard deviations.
_UNEXPLORED = 6.0


@dataclass(frozen=True)
class Levels:
    """Error rates the verdict works to, and the number of imagined studies.

    Parameters
    ----------
    search : float
        Chance that a candidate gains enough although nothing is hidden.
    residual : float
        A model whose residual is less likely than this is rejected.
    rival : float
        A rival stays in the group unless it is less likely than this to lose so clearly.
    draws : int
        Imagined studies.
    """

    search: float = 0.03
    residual: float = 0.01
    rival: float = 0.05
    draws: int = 1000


@dataclass(frozen=True)
class Suspect:
    """One candidate after its own joint fit.

    Parameters
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


@dataclass(frozen=True)
class Verdict:
    """What the data say.

    Parameters
    ----------
    kind : str
        ``none``, ``named``, ``group`` or ``unknown``.
    names : tuple of str
        The named cause, or the members of the group, best first.
    p_misfit : float
        Chance of a misfit as large as the base model's if the base model is right.
    p_search : float
        Chance that the best of all candidates gains this much if the base model is right.
    threshold : float
        Gain that a candidate needs.
    best_gain : float
    suspects : tuple of Suspect
        All candidates, best first; empty when nothing is significant.
    intervals : mapping
        Candidate -> its profile, for every name.
    reason : str
        One sentence.
    """

    kind: str
    names: tuple[str, ...]
    p_misfit: float
    p_search: float
    threshold: float
    best_gain: float
    suspects: tuple[Suspect, ...]
    intervals: dict[str, Profile]
    reason: str


def _tail(draws: Array, value: float) -> float:
    """Chance of at least `value`, never zero: the observed case counts as one draw."""
    return float((1 + np.sum(draws >= value)) / (1 + len(draws)))


@dataclass(frozen=True)
class Court:
    """What every step of the verdict needs.

    Parameters
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


def null_frames(court: Court) -> Frame:
    """Imagined studies in which the base model is right."""
    here = frame(court.stack, court.base)
    zero = np.zeros(len(court.stack.y))
    return imagine(court.stack, court.base, here, court.noise(court.base), zero)


def judge(court: Court, nulls: Frame) -> Verdict:
    """Reach the verdict.

    Parameters
    ----------
    court : Court
    nulls : Frame
        From `null_frames`.
    """
    seen, imagined = screen(frame(court.stack, court.base)), screen(nulls)
    p_misfit = _tail(imagined.total, float(seen.total))
    best_null = imagined.gain.max(axis=1) if imagined.gain.shape[1] else np.zeros(1)
    best = float(seen.gain.max(initial=0.0))
    p_score = _tail(best_null, best)
    suspects: tuple[Suspect, ...] = ()
    if len(seen.gain) and (p_misfit <= _LOOK_MISFIT or p_score <= _LOOK_SCORE):
        suspects = _suspects(court, seen.gain)
        best = max(s.gain for s in suspects)
    verdict = Verdict(
        kind="none",
        names=(),
        p_misfit=p_misfit,
        p_search=_tail(best_null, best),
        threshold=float(np.quantile(best_null, 1.0 - court.levels.search)),
        best_gain=best,
        suspects=(),
        intervals={},
        reason="the residuals are no larger than their errors explain",
    )
    if verdict.p_search <= court.levels.search:
        named = _name(court, verdict, suspects)
        lead = court.wide.objective - min(s.fitted.objective for s in suspects)
        doubtful = court.base.edge and _tail(best_null, lead) > court.levels.search
        return _withheld(named) if doubtful and named.names else named
    if p_misfit <= court.levels.residual:
        why = "the misfit is significant, but no candidate explains a significant part of it"
        return replace(verdict, kind="unknown", reason=why)
    return verdict


def _suspects(court: Court, gains: Array) -> tuple[Suspect, ...]:
    """Joint fit of every candidate and how well each stands against the best one."""
    candidates = court.stack.problem.candidates
    here = screen(frame(court.stack, court.base))
    fits = [_best_fit(court, c, float(s)) for c, s in zip(candidates, here.strength, strict=True)]
    order = sorted(range(len(fits)), key=lambda k: fits[k].objective)
    best = order[0]
    rows = []
    for k in order:
        p_residual, levels = _residual_chance(court, fits[k], k)
        lead = fits[k].objective - fits[best].objective
        rows.append(
            Suspect(
                candidate=candidates[k].name,
                strength=fits[k].strengths[candidates[k].name],
                gain=max(float(gains[k]), court.base.objective - fits[k].objective),
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
    p_residual = _tail(drawn.total - drawn.gain[:, 0], float(seen.total - seen.gain[0]))
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
    return _tail(drawn.gain[:, 1] - drawn.gain[:, 0], lead)


def _withheld(verdict: Verdict) -> Verdict:
    """Take the names back: a base fit that was stopped on its way misfits by construction.

    Allowed to go on, on the extrapolated surrogate, it explains the data well enough.
    """
    why = (
        f"{' or '.join(verdict.names)} would explain the misfit, but so might the base model "
        "beyond the runs made so far; more designs are needed"
    )
    return replace(verdict, kind="unknown", names=(), reason=why)


def _stays(one: Suspect, best: Suspect, levels: Levels) -> bool:
    """Whether a suspect cannot be excluded.

    A fit that was stopped at the edge of the runs made so far might go on improving beyond it.
    """
    if one is best:
        return True
    if one.fitted.edge and one.fitted.objective - best.fitted.objective < _UNEXPLORED:
        return True
    return one.p_rival > levels.rival and one.p_residual > levels.residual


def _name(court: Court, blank: Verdict, suspects: tuple[Suspect, ...]) -> Verdict:
    """Turn fitted suspects into a name, a group, or unknown."""
    levels = court.levels
    found = replace(blank, suspects=suspects)
    if suspects[0].p_residual <= levels.residual:
        why = (
            f"the best candidate, {suspects[0].candidate}, leaves a residual it cannot explain "
            f"(p = {suspects[0].p_residual:.3f})"
        )
        return replace(found, kind="unknown", reason=why)
    kept = [s for s in suspects if _stays(s, suspects[0], levels)]
    by_name = {c.name: c for c in court.stack.problem.candidates}
    here = screen(frame(court.stack, court.base))
    names = [c.name for c in court.stack.problem.candidates]
    intervals = {}
    for s in kept:
        scale = 1.0 / np.sqrt(max(float(here.information[names.index(s.candidate)]), 1e-12))
        intervals[s.candidate] = profile(
            court.task(by_name[s.candidate]), s.fitted, scale, s.levels
        )
    found = replace(found, names=tuple(s.candidate for s in kept), intervals=intervals)
    low, high = intervals[kept[0].candidate].interval95
    if low <= 0.0 <= high:
        why = f"the interval of the best candidate, {kept[0].candidate}, contains zero"
        return replace(found, kind="none", names=(), reason=why)
    if len(kept) > 1:
        why = "these causes fit equally well; the data cannot tell them apart"
        return replace(found, kind="group", reason=why)
    why = f"{kept[0].candidate} explains the misfit and every rival would have looked different"
    return replace(found, kind="named", reason=why)
