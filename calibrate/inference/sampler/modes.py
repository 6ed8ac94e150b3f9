"""Where a posterior lies: its modes, looked for from a cloud that was annealed from the prior.

Newton's method ends on the nearest hill. With curves, or an effect in the data that the model does
not know, a posterior of nine unknowns has a dozen of them, and of the likely points of the prior
one in sixteen leads to the highest. A small cloud that follows the posterior while the data are
counted more and more is led there by the heights of the hills.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.errors import CalibrationError
from calibrate.inference.likelihood import IMPOSSIBLE
from calibrate.inference.sampler.anneal import annealed
from calibrate.inference.sampler.laplace import climb, mixture_of
from calibrate.inference.sampler.mixture import Mixture
from calibrate.inference.sampler.target import Density

__all__ = ["apart", "find_modes", "starting_points"]

PRIOR_DRAWS: Final = 2000
CLOUD: Final = 300
MOVES: Final = 10
"""Of the cloud at one power, at most."""
OF_CLOUD: Final = 5
LIKELY: Final = 2
"""Starts in the cloud and among likely points of the prior; its centre is the last."""

_SHARE: Final = 0.3  # of the whole work of a sampler that starts with this
_ANNEALED: Final = 0.2


def find_modes(target: Density, rng: np.random.Generator) -> Mixture:
    """Search from several points; return a component for every mode.

    Parameters
    ----------
    target : Density
    rng : Generator

    Returns
    -------
    Mixture
        Weights by Laplace's approximation of each mode's evidence.

    Raises
    ------
    CalibrationError
        If no point of the prior can have given the data.
    """
    starts = starting_points(target, rng)
    found = []
    for number, z in enumerate(starts):
        target.progress(_ANNEALED + (_SHARE - _ANNEALED) * number / len(starts))
        found.append(climb(target, z))
    return mixture_of(found)


def starting_points(target: Density, rng: np.random.Generator) -> list[Array]:
    """Return points from which modes are looked for, the most promising first.

    Points of the annealed cloud that lie apart, likely ones of the prior, and the prior's centre.

    Parameters
    ----------
    target : Density
    rng : Generator

    Returns
    -------
    list of (K,) float64

    Raises
    ------
    CalibrationError
        If no point of the prior can have given the data.
    """
    z = Mixture.prior(target.size).draw(PRIOR_DRAWS, rng)
    value = target.log_posterior(z)
    possible = value > IMPOSSIBLE
    if not possible.any():
        msg = (
            f"unknowns: none of {PRIOR_DRAWS} points of the prior can have given these data, the "
            "emulators predict nothing there; look for failed runs, or change the ranges"
        )
        raise CalibrationError(msg)
    z, value = z[possible], value[possible]
    likely = np.argsort(-value)[: max(len(z) // 20, 1)]

    def tell(power: float) -> None:
        target.progress(_ANNEALED * power)

    there = annealed(target, _some(z, CLOUD, rng), rng, tell, MOVES).cloud
    high = np.argsort(-there.log_p)
    return [
        *apart(there.z[high], OF_CLOUD),
        *apart(z[likely], LIKELY),
        np.zeros(target.size),
    ]


def _some(z: Array, count: int, rng: np.random.Generator) -> Array:
    """Return so many of the points, (count, K), some of them more than once where they are few."""
    return np.asarray(z[np.resize(rng.permutation(len(z)), count)])


def apart(z: Array, count: int) -> list[Array]:
    """Return the first of points (n, K), and others that lie far from each other, at most count."""
    chosen = [z[0]]
    while len(chosen) < min(count, len(z)):
        away = np.min([np.sum((z - one) ** 2, axis=1) for one in chosen], axis=0)
        chosen.append(z[int(np.argmax(away))])
    return chosen
