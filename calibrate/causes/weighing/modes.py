"""Where posteriors lie, with and without causes: Gauss and Newton on a straightened bench."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from calibrate.arrays import Array
from calibrate.causes.candidates import Candidate
from calibrate.causes.strengths.grids import Line, Plane
from calibrate.causes.strengths.prior import StrengthPrior
from calibrate.causes.strengths.terms import Cross, Terms
from calibrate.causes.weighing.bench import Bench, bench_at
from calibrate.causes.weighing.effects import Added, added_by
from calibrate.causes.weighing.switched import terms_with
from calibrate.causes.weighing.tangent import Tangent, tangent_at
from calibrate.inference.problem import Problem

__all__ = ["Mode", "mode_near"]

ROUNDS: Final = 12
PARTS: Final = (1.0, 0.4, 0.15, 0.04)
"""Of a step, as long as nothing high enough is found."""
ENOUGH: Final = 0.1
"""Of what the slope promises, what a part of a step has to gain: less may be the other side of the
hill (the rule of Armijo)."""
SETTLED: Final = 0.02  # nats by which a step must make a mode better
LONGEST: Final = 2.0  # prior deviations of one step


@dataclass(frozen=True, eq=False)
class Mode:
    """Where a posterior is highest, roughly.

    Attributes
    ----------
    z : (K,) float64
    strengths : (m,) float64
        Of the members, ordinary ones.
    covariance : (K, K) float64
        Of z, the strengths unknown.
    height : float
        Log posterior density there, up to a constant that all modes share.
    log_evidence : float
        By Laplace's method.
    tangent : Tangent
    parts : tuple of ((N,), (N,)) float64
        What each member adds there, see `Tangent.stacked`.
    """

    z: Array
    strengths: Array
    covariance: Array
    height: float
    log_evidence: float
    tangent: Tangent
    parts: tuple[tuple[Array, Array], ...]


def mode_near(
    problem: Problem,
    z: Array,
    members: Sequence[Candidate] = (),
    priors: Sequence[StrengthPrior] = (),
    rounds: int = ROUNDS,
) -> Mode:
    """Return the mode of a hypothesis near a point.

    Parameters
    ----------
    problem : Problem
        The base model.
    z : (K,) float64
    members : sequence of Candidate
        At most two.
    priors : sequence of StrengthPrior
        Of their strengths.
    rounds : int
    """
    best = _settled(tangent_at(problem, z), members, priors)
    for _ in range(rounds):
        before = best.height
        for move, rise in _moves(best, members, priors):
            best = _along(problem, best, move, rise, members, priors)
            if best.height > before + SETTLED:
                break
        else:
            break
    return best


def _along(
    problem: Problem,
    best: Mode,
    move: Array,
    rise: float,
    members: Sequence[Candidate],
    priors: Sequence[StrengthPrior],
) -> Mode:
    """Return the first point high enough that parts of a move reach, or the best as it was.

    `rise` is what the whole move would gain were the slope the same all the way.
    """
    z = best.z + np.array(PARTS)[:, None] * move
    bench = bench_at(problem, problem.space.from_normal(z))
    added = [added_by(bench, one) for one in members]
    for k, part in enumerate(PARTS):
        row = np.array([k])
        here = bench.rows(row)
        x, _ = _best(here, [one.rows(row) for one in added], priors)
        high = _height(here, z[k], members, x, priors)
        if high > best.height + ENOUGH * part * rise:
            return _settled(tangent_at(problem, z[k]), members, priors)
    return best


def _height(
    bench: Bench,
    z: Array,
    members: Sequence[Candidate],
    x: Array,
    priors: Sequence[StrengthPrior],
) -> float:
    """Return the log posterior density of one draw at strengths x, (m,).

    By the likelihood itself: far from the data the grids of strengths take an error that repeats
    told and that of an emulator together for one Student's t, which may differ by tens of nats.
    """
    height = terms_with(bench, members, x[None], np.array([0])).sum() + bench.known[0]
    for one, prior in zip(x, priors, strict=True):
        height += prior.log_density(np.array([one]))[0]
    return float(height - 0.5 * z @ z)


def _strengths(
    left: Array,
    parts: Sequence[tuple[Array, Array]],
    priors: Sequence[StrengthPrior],
    inverse: Array,
) -> tuple[Array, float]:
    """Return the most probable strengths, and the log integral over them.

    Parameters
    ----------
    left : (N,) float64
    parts : sequence of ((N,), (N,))
        Slope and bend of each member.
    priors : sequence of StrengthPrior
    inverse : (N, N) float64
        Inverse covariance in which they are judged.
    """
    if not parts:
        return np.zeros(0), 0.0
    turned = [(inverse @ a, inverse @ c) for a, c in parts]
    whole = left @ inverse @ left
    terms = [
        Terms(
            np.array([whole, left @ ta, left @ tc, a @ ta, a @ tc, c @ tc])[:, None],
            np.zeros(1),
            np.zeros(1),
            len(left),
        )
        for (a, c), (ta, tc) in zip(parts, turned, strict=True)
    ]
    nothing = np.zeros(1)
    if len(parts) == 1:
        line = Line.of(terms[:1], priors[0], nothing)
        at = int(np.argmax(line.log_part[0]))
        return line.nodes[[at]], float(line.log_integral[0])
    (a, c), (b, d) = parts[0], turned[1]
    mixed = np.array([a @ b, a @ d, c @ b, c @ d])[:, None]
    plane = Plane.of([Cross(terms[0], terms[1], mixed)], (priors[0], priors[1]), nothing)
    i, j = np.unravel_index(int(np.argmax(plane.log_part[0])), plane.log_part[0].shape)
    return np.array([plane.first[i], plane.second[j]]), float(plane.log_integral[0])


def _best(
    bench: Bench, added: Sequence[Added], priors: Sequence[StrengthPrior]
) -> tuple[Array, float]:
    """Return the most probable strengths at one draw, and the log width of all that are.

    The width is the integral over strengths, divided by the density where it is highest.
    """
    if not added:
        return np.zeros(0), 0.0
    if len(added) == 1:
        line = Line.of(added[0].terms(bench), priors[0], np.zeros(1))
        at = int(np.argmax(line.log_part[0]))
        return line.nodes[[at]], float(line.log_integral[0] - line.log_part[0, at])
    cross = added[0].cross(added[1], bench)
    plane = Plane.of(cross, (priors[0], priors[1]), np.zeros(1))
    i, j = np.unravel_index(int(np.argmax(plane.log_part[0])), plane.log_part[0].shape)
    best = np.array([plane.first[i], plane.second[j]])
    return best, float(plane.log_integral[0] - plane.log_part[0, i, j])


def _sum(parts: Sequence[tuple[Array, Array]], x: Array, size: int) -> Array:
    total = np.zeros(size)
    for (a, c), one in zip(parts, x, strict=True):
        total += one * (a + one * c)
    return total


def _moves(
    best: Mode, members: Sequence[Candidate], priors: Sequence[StrengthPrior]
) -> Iterator[tuple[Array, float]]:
    """Yield ways uphill, (K,), and what they would gain on the slope here; the best to try first.

    First to the middle of the straightened posterior. Where the emulators' variances change on the
    way, nothing higher may lie there; then uphill, by the slope of the density itself.
    """
    here, parts = best.tangent, best.parts
    factor = cho_factor(here.covariance)
    left = here.left + here.slopes @ here.z
    x, _ = _strengths(left, parts, priors, cho_solve(factor, np.eye(len(left))))
    middle = here.slopes.T @ cho_solve(factor, left - _sum(parts, x, len(left)))
    slope = here.uphill(members, best.strengths) - here.z
    precision = np.eye(len(here.z)) + here.slopes.T @ here.slopes
    for move in (np.asarray(middle - here.z), np.linalg.solve(precision, slope)):
        short = _limited(move)
        rise = float(slope @ short)
        if rise > SETTLED:  # what is bent down gains less than that
            yield short, rise


def _limited(move: Array) -> Array:
    """Return a move that goes no further than `LONGEST` in any coordinate."""
    return move * min(1.0, LONGEST / max(float(np.abs(move).max()), 1e-12))


def _settled(here: Tangent, members: Sequence[Candidate], priors: Sequence[StrengthPrior]) -> Mode:
    """Return height, width and Laplace's evidence at a point."""
    size = len(here.z)
    own_added = [added_by(here.bench, one) for one in members]
    x, wide = _best(here.bench, own_added, priors)
    here = here.stretched(_sum([here.stacked(one) for one in own_added], x, len(here.left)))
    parts = tuple(here.stacked(one) for one in own_added)
    height = _height(here.bench, here.z, members, x, priors)
    slopes = [here.slopes]
    for (a, c), one, prior in zip(parts, x, priors, strict=True):
        width = 0.0 if prior.fixed else prior.width
        slopes.append(width * (a + 2.0 * one * c)[:, None])
    together = np.column_stack(slopes)
    precision = np.eye(together.shape[1]) + together.T @ together
    covariance = np.linalg.inv(precision)[:size, :size]
    # The strengths are integrated; what is left is as wide in z as they let it be.
    log_evidence = height + wide + 0.5 * float(np.linalg.slogdet(covariance)[1])
    return Mode(here.z, x, covariance, height, log_evidence, here, parts)
