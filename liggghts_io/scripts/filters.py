"""Arithmetic of the script templates: everything a template computes is a function here."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Sequence
from functools import lru_cache
from typing import Final, TypeAlias

from liggghts_io.errors import CaseError

Sizes: TypeAlias = Sequence[tuple[float, float]]
"""Pairs of diameter [m] and mass fraction [-]."""

_SMALLEST_SEED: Final = 10007
_SEED_SPAN: Final = 2_000_000_000  # below 2^31 with room for what LIGGGHTS adds to a seed


def number(value: float) -> str:
    """Format a number for a script: 10 significant digits, no superfluous zeros.

    Raises
    ------
    CaseError
        If the value is not finite.
    """
    if not math.isfinite(value):
        msg = f"a script cannot hold the number {value!r}"
        raise CaseError(msg)
    return f"{value:.10g}"


def rayleigh_time(diameter: float, density: float, youngs: float, poisson: float) -> float:
    """Time a Rayleigh wave needs around half a grain [s].

    References
    ----------
    Grobbel et al. (2019), eq. 6: pi R sqrt(rho / G) / (0.8766 + 0.1631 nu) with
    G = Y / (2 (1 + nu)).
    """
    shear = youngs / (2.0 * (1.0 + poisson))
    return math.pi * 0.5 * diameter * math.sqrt(density / shear) / (0.8766 + 0.1631 * poisson)


def time_step(
    sizes: Sizes, density: float, youngs: float, poisson: float, fraction: float
) -> float:
    """Largest time step with three digits that is no longer than `fraction` of eq. 6 [s]."""
    if not 0.0 < fraction <= 0.3:
        msg = f"time step fraction {fraction:g}: stable runs need 0 < fraction <= 0.3 (paper: 0.2)"
        raise CaseError(msg)
    smallest = min(diameter for diameter, _ in sizes)
    limit = fraction * rayleigh_time(smallest, density, youngs, poisson)
    unit = 10.0 ** (math.floor(math.log10(limit)) - 2)
    return math.floor(limit / unit * (1.0 + 1e-12)) * unit


def steps(duration: float, step: float) -> int:
    """Return the number of whole time steps nearest to a duration, at least one."""
    return max(1, round(duration / step))


def frame_steps(duration: float, step: float, frames: float) -> int:
    """Return the steps between two frames so that `frames` of them fill a duration."""
    return max(1, round(duration / step / frames))


def mean_mass(sizes: Sizes, density: float) -> float:
    """Mean mass of a grain over numbers, from mass fractions [kg]."""
    total = sum(fraction for _, fraction in sizes)
    per_mass = sum(
        fraction / (density * math.pi / 6.0 * diameter**3) for diameter, fraction in sizes
    )
    return total / per_mass


def grains(mass: float, sizes: Sizes, density: float) -> float:
    """Return how many grains of mean mass make up `mass`; with [kg/s] the grains per second."""
    return mass / mean_mass(sizes, density)


def whole(value: float) -> int:
    """Round to the nearest integer, at least one."""
    return max(1, round(value))


def sin_deg(angle: float) -> float:
    """Return the sine of an angle in degrees."""
    return math.sin(math.radians(angle))


def cos_deg(angle: float) -> float:
    """Return the cosine of an angle in degrees."""
    return math.cos(math.radians(angle))


def tan_deg(angle: float) -> float:
    """Return the tangent of an angle in degrees."""
    return math.tan(math.radians(angle))


def pair_matrix(
    particle: float, wall: float, apparatus: float, between: float | None = None
) -> str:
    """Row-major symmetric 3 x 3 matrix over the types particle, wall under test, apparatus.

    Walls never touch each other; their entries repeat the particle-wall value. `between` is that
    of the last two types where the third is one of grains.
    """
    pair = wall if between is None else between
    row = [particle, wall, apparatus, wall, wall, pair, apparatus, pair, apparatus]
    return " ".join(number(value) for value in row)


def _is_prime(n: int) -> bool:
    """Deterministic Miller-Rabin test for n < 3.2e9 (bases 2, 3, 5, 7)."""
    if n < 11:
        return n in (2, 3, 5, 7)
    if any(n % p == 0 for p in (2, 3, 5, 7)):
        return False
    odd, twos = n - 1, 0
    while odd % 2 == 0:
        odd, twos = odd // 2, twos + 1
    for base in (2, 3, 5, 7):
        x = pow(base, odd, n)
        if x in (1, n - 1):
            continue
        for _ in range(twos - 1):
            x = x * x % n
            if x == n - 1:
                break
        else:
            return False
    return True


@lru_cache(maxsize=256)  # many cases of a campaign share their seed
def prime_seeds(seed: int, count: int) -> tuple[int, ...]:
    """Return `count` different primes above 10000 that depend on the case seed only.

    LIGGGHTS refuses other seeds and equal seeds within one insertion chain.
    """
    found: list[int] = []
    k = 0
    while len(found) < count:
        digest = hashlib.sha256(f"{seed}:{k}".encode()).digest()
        candidate = _SMALLEST_SEED + int.from_bytes(digest[:8], "big") % _SEED_SPAN
        while not _is_prime(candidate):
            candidate += 1
        if candidate not in found:
            found.append(candidate)
        k += 1
    return tuple(found)


FILTERS: Final = {
    "number": number,
    "time_step": time_step,
    "steps": steps,
    "frame_steps": frame_steps,
    "grains": grains,
    "whole": whole,
    "prime_seeds": prime_seeds,
    "sin_deg": sin_deg,
    "cos_deg": cos_deg,
    "tan_deg": tan_deg,
}
GLOBALS: Final = {"pair_matrix": pair_matrix}
