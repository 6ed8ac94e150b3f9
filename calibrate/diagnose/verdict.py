"""The verdict: nothing, one named cause, a group, or unknown, with calibrated error rates.

Every threshold comes from imagined repetitions of the whole study (parametric bootstrap with
refit): measurement errors as uncertain as their repeats make them, surrogate errors of value,
slopes and signatures, and the search over all candidates.

1. Does the best candidate gain more than it would without any effect? (`p_search`)
2. Does it leave a residual that its own model can explain? (`p_residual` above 5 %)
3. Which rivals would, if true, let it look this much better? They stay in the group.
4. If no candidate gains enough, is the misfit itself too large? Then the cause is unknown.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from calibrate.diagnose.fit import Profile, ahead, profile
from calibrate.diagnose.scores import Frame, frame, imagine, screen
from calibrate.diagnose.suspects import Court, Levels, Suspect, suspects_of, tail

__all__ = ["Court", "Levels", "Suspect", "Verdict", "judge", "null_frames"]

# Candidates get their own joint fit when the misfit or the best score is at all remarkable.
_LOOK_MISFIT = 0.05
_LOOK_SCORE = 0.3
# How far behind (in -2 log likelihood) a fit stopped at the edge of the runs may be and still be
# suspected: about two and a half standard deviations.
_UNEXPLORED = 6.0


@dataclass(frozen=True)
class Verdict:
    """What the data say.

    Attributes
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
    p_misfit = tail(imagined.total, float(seen.total))
    best_null = imagined.gain.max(axis=1) if imagined.gain.shape[1] else np.zeros(1)
    best = float(seen.gain.max(initial=0.0))
    p_score = tail(best_null, best)
    suspects: tuple[Suspect, ...] = ()
    if len(seen.gain) and (p_misfit <= _LOOK_MISFIT or p_score <= _LOOK_SCORE):
        suspects = suspects_of(court, seen.gain)
        best = max(s.gain for s in suspects)
    verdict = Verdict(
        kind="none",
        names=(),
        p_misfit=p_misfit,
        p_search=tail(best_null, best),
        threshold=float(np.quantile(best_null, 1.0 - court.levels.search)),
        best_gain=best,
        suspects=(),
        intervals={},
        reason="the residuals are no larger than their errors explain",
    )
    if verdict.p_search <= court.levels.search:
        named = _name(court, verdict, suspects)
        lead = court.wide.objective - min(s.fitted.objective for s in suspects)
        doubtful = court.base.edge and tail(best_null, lead) > court.levels.search
        return _withheld(named) if doubtful and named.names else named
    if p_misfit <= court.levels.residual:
        why = "the misfit is significant, but no candidate explains a significant part of it"
        return replace(verdict, kind="unknown", reason=why)
    return verdict


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
    if one.fitted.edge and ahead(best.fitted, one.fitted) < _UNEXPLORED:
        return True
    return one.p_rival > levels.rival and one.p_residual > levels.explained


def _name(court: Court, blank: Verdict, suspects: tuple[Suspect, ...]) -> Verdict:
    """Turn fitted suspects into a name, a group, or unknown."""
    levels = court.levels
    found = replace(blank, suspects=suspects)
    if suspects[0].p_residual <= levels.explained:
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
