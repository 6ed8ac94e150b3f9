"""Sizes of the simulated grains: classes of a measured distribution, one size, coarse graining."""

from __future__ import annotations

import math
from itertools import pairwise
from statistics import NormalDist
from typing import Final

from liggghts_io.errors import CaseError
from liggghts_io.materials import MEASURED, Particle, SizeClasses

_NORMAL: Final = NormalDist()
_Z90: Final = _NORMAL.inv_cdf(0.9)

SMALLEST: Final = 0.1
"""Above the measured spread no class shrinks below this part of the middle one, unless it was
measured so: a wide distribution would end at grains of no size, which set the time step."""

LOWEST_RESTITUTION: Final = 0.05
"""LIGGGHTS 3.8.0 takes restitution above it."""


def quantile_spread(d10: float, d90: float) -> float:
    """Return the standard deviation of the logarithm of a log-normal distribution, eq. of d90."""
    return math.log(d90 / d10) / (2.0 * _Z90)


def lognormal_classes(median: float, spread: float, count: int) -> SizeClasses:
    """Cut a log-normal distribution into classes of equal mass.

    Each class has the Sauter diameter of its grains, so that mass and surface of the classes, and
    with them the Sauter diameter of the mixture, are those of the whole distribution.

    Parameters
    ----------
    median : float
        Of the *number* of grains.
    spread : float
        Standard deviation of ln d.
    count : int
        Number of classes.

    Returns
    -------
    tuple of (float, float)
        Diameter, in the unit of the median, and share of the *number* of grains.

    Notes
    -----
    The k-th moment of ln N(mu, s^2) below x is the whole one times Phi((ln x - mu) / s - k s). Cuts
    at quantiles of the mass (k = 3) have there z; the surface (k = 2) has z + s.
    """
    sauter = median * math.exp(2.5 * spread**2)
    cuts = [_NORMAL.inv_cdf(k / count) for k in range(1, count)]
    surface = [0.0, *(_NORMAL.cdf(z + spread) for z in cuts), 1.0]
    diameters = [sauter / count / (high - low) for low, high in pairwise(surface)]
    return by_number([(diameter, 1.0 / count) for diameter in diameters])


def by_number(classes: SizeClasses | list[tuple[float, float]]) -> SizeClasses:
    """Turn shares of the mass into shares of the number of grains; diameters rise.

    Examples
    --------
    >>> by_number([(2.0, 8.0), (1.0, 1.0)])
    ((1.0, 0.5), (2.0, 0.5))
    """
    numbers = [(diameter, mass / diameter**3) for diameter, mass in sorted(classes)]
    total = sum(count for _, count in numbers)
    return tuple((diameter, count / total) for diameter, count in numbers)


def median_class(classes: SizeClasses) -> float:
    """Return the diameter of the class that holds the middle grain [m]."""
    counted = 0.0
    for diameter, share in classes:
        counted += share
        if counted >= 0.5:
            return diameter
    return classes[-1][0]  # shares that rounding leaves short of a half


def mixture(particle: Particle, spread: float) -> list[tuple[float, float]]:
    """Return diameter [m] and mass fraction of each class of the simulated grains.

    Parameters
    ----------
    particle : Particle
    spread : float
        Part of the measured spread: 0 for grains of Sauter diameter, 1 for the measured sizes.

    Returns
    -------
    list of (float, float)
        The Sauter diameter of the mixture is that of the particle, times its coarse graining.
    """
    size = particle.d32_m * particle.coarse_graining
    if spread == 0.0:
        return [(size, 1.0)]
    middle = median_class(particle.size_classes)
    shares = [share for _, share in particle.size_classes]
    ratios = [diameter / middle for diameter, _ in particle.size_classes]
    scaled = [max(1.0 + spread * (ratio - 1.0), min(ratio, SMALLEST)) for ratio in ratios]
    cubes = [share * s**3 for share, s in zip(shares, scaled, strict=True)]
    squares = [share * s**2 for share, s in zip(shares, scaled, strict=True)]
    unit = size * sum(squares) / sum(cubes)
    total = sum(cubes)
    return [(unit * s, cube / total) for s, cube in zip(scaled, cubes, strict=True)]


def simulated_sizes(particle: Particle) -> list[tuple[float, float]]:
    """Return diameter [m] and mass fraction of each class, as the particle is simulated.

    Raises
    ------
    CaseError
        If the measured sizes are asked for and there are none.
    """
    if particle.base_sizes == MEASURED:
        particle.need(["size_classes"], f"sizes = {MEASURED!r}")
        return mixture(particle, 1.0)
    return mixture(particle, 0.0)


def extra_radius(particle: Particle) -> float:
    """Return by how much the largest simulated grain's radius exceeds half the real diameter [m].

    A region in which whole grains appear is that much larger on each side, so that the centres of
    the grains have the same room and their flow stays.
    """
    largest = max(diameter for diameter, _ in simulated_sizes(particle))
    return 0.5 * (largest - particle.d32_m)


def coarse_restitution(restitution: float, factor: float) -> float:
    """Return the restitution between coarse grains that lose as much energy as the real ones.

    Parameters
    ----------
    restitution : float
        Between real grains.
    factor : float
        Diameter of the simulated over that of the real grains.

    Raises
    ------
    CaseError
        If there is none: coarse grains collide so rarely that no restitution loses enough.

    References
    ----------
    Grobbel et al. (2019), section 3.4, eqs. 20 to 22: of N grains in a volume each collides in
    proportion to d^2 N, and N falls with CG^3, so collisions of all grains fall with CG^4 and each
    loses CG^3 (1 - e^2) times as much energy: 1 - e*^2 = CG (1 - e^2). Against a wall the same
    argument leaves restitution as it is.
    """
    if factor == 1.0:
        return restitution
    square = 1.0 - factor * (1.0 - restitution**2)
    if square > LOWEST_RESTITUTION**2:
        return math.sqrt(square)
    loss = 1.0 - LOWEST_RESTITUTION**2
    # A thousandth inside the limits, so that the values in the message are taken.
    largest = math.floor(999.0 * loss / (1.0 - restitution**2)) / 1000.0
    smallest = math.ceil(1001.0 * math.sqrt(1.0 - loss / factor)) / 1000.0
    remedy = f"raise e_pp to {smallest:g} or more"
    if largest > 1.0:
        remedy += f", or take coarse_graining = {largest:g} or less"
    msg = (
        f"coarse_graining = {factor:g} with e_pp = {restitution:g}: grains that much larger "
        "collide too rarely to lose as much energy (e*^2 = 1 - CG (1 - e^2) is "
        f"{square:.3g}, and has to be above {LOWEST_RESTITUTION**2:g}); {remedy}"
    )
    raise CaseError(msg)
