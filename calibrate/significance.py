"""How large a difference is in its errors, and what may be said about it: one rule for all words.

Whoever prints a difference as a number of standard errors and says beside it whether the errors
explain it takes both from here, so that number and sentence cannot disagree.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

from scipy import stats

__all__ = [
    "SIGNIFICANT",
    "deviation_percent",
    "joint_dof",
    "normal_score",
    "shown",
    "significant",
    "weighed",
    "worst_of",
]

SIGNIFICANT: Final = 2.0
"""Standard errors beyond which chance is an unlikely reason: one value in twenty-two passes it."""


def deviation_percent(simulated: float, measured: float) -> float:
    """Return how far a value is off, in per cent of the size of the measured one.

    Examples
    --------
    >>> round(deviation_percent(-38.0, -40.0), 6), deviation_percent(1.0, 0.0)
    (5.0, nan)
    """
    return 100.0 * (simulated - measured) / abs(measured) if measured else math.nan


def shown(z: float) -> str:
    """Return a difference in standard errors as it is printed everywhere.

    Examples
    --------
    >>> shown(-4.93)
    '-4.9'
    """
    return f"{z:+.1f}" if math.isfinite(z) else "n/a"


def significant(z: float) -> bool:
    """Return whether the printed difference is beyond `SIGNIFICANT`.

    The printed one: 2.04 is shown as +2.0, and a reader who sees that reads "not beyond 2".

    Examples
    --------
    >>> significant(2.04), significant(-2.06), significant(float("nan"))
    (False, True, False)
    """
    return math.isfinite(z) and abs(float(shown(z))) > SIGNIFICANT


def weighed(*z: float, errors: str) -> str:
    """Return differences and what follows from them, as the end of a sentence.

    Parameters
    ----------
    *z : float
        Differences in standard errors.
    errors : str
        Whose errors they were divided by.

    Examples
    --------
    >>> weighed(-4.93, 0.2, errors="measurement and simulation")
    'z = -4.9 and +0.2, more than the errors of measurement and simulation explain'
    >>> weighed(1.2, errors="measurement and surrogate")
    'z = +1.2, which the errors of measurement and surrogate can explain'
    """
    numbers = " and ".join(shown(one) for one in z)
    if any(significant(one) for one in z):
        return f"z = {numbers}, more than the errors of {errors} explain"
    return f"z = {numbers}, which the errors of {errors} can explain"


def worst_of(z: Sequence[float]) -> float:
    """Return the largest of several differences, as unlikely as it is among so many.

    Parameters
    ----------
    z : sequence of float
        Differences in standard errors, as normal deviates; one is returned as it is.

    Examples
    --------
    >>> worst_of([-2.5]), round(worst_of([0.3, -2.5, 1.0, 0.1]), 2)
    (-2.5, -1.96)
    """
    worst = max(z, key=abs)
    if len(z) == 1 or not math.isfinite(worst):
        return worst
    share = min(len(z) * float(stats.norm.sf(abs(worst))), 0.5)
    return math.copysign(min(float(stats.norm.isf(share)), abs(worst)), worst)


def joint_dof(first: tuple[float, float], second: tuple[float, float]) -> float:
    """Return the degrees of freedom of a difference of two means (Welch and Satterthwaite).

    Parameters
    ----------
    first, second : (float, float)
        Standard error of a mean and its degrees of freedom, infinite where the error is known.

    Examples
    --------
    >>> joint_dof((1.0, 4.0), (1.0, 4.0))
    8.0
    """
    spread = math.fsum(error**4 / dof for error, dof in (first, second))
    total = first[0] ** 2 + second[0] ** 2
    return total**2 / spread if spread > 0.0 else math.inf


def normal_score(t: float, dof: float) -> float:
    """Return the normal deviate that is as unlikely as Student's `t`.

    A standard error from three runs is itself uncertain; by chance alone such a ratio is beyond
    4.3 as often as a normal deviate is beyond 2.

    Parameters
    ----------
    t : float
        Difference over its estimated standard error.
    dof : float
        Degrees of freedom of that error.

    Examples
    --------
    >>> round(normal_score(-4.30, 2.0), 2), normal_score(3.0, math.inf)
    (-1.96, 3.0)
    """
    if not (math.isfinite(t) and math.isfinite(dof)):
        return t
    deviate = float(stats.norm.isf(stats.t.sf(abs(t), dof)))
    return math.copysign(min(deviate, abs(t)), t)  # a tail below 1e-308 would give infinity
