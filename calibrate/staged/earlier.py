"""What earlier stages of a calibration hand on: chosen values and their uncertainty."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from calibrate.arrays import Array

__all__ = ["Earlier"]

JITTER = 0.03  # friction and restitution coefficients; a twentieth of the usual ranges


@dataclass(frozen=True)
class Earlier:
    """What earlier stages found: chosen values and samples that carry their uncertainty.

    Attributes
    ----------
    keys : tuple of (str, str)
        Name and instance of the parameters found so far, m of them.
    values : (m,) float64
        Chosen values, in the parameters' own units.
    samples : (n, m) float64
        Draws from their posteriors.
    """

    keys: tuple[tuple[str, str], ...] = ()
    values: Array = field(default_factory=lambda: np.empty(0))
    samples: Array = field(default_factory=lambda: np.empty((1, 0)))

    @property
    def scale(self) -> Array:
        """Root mean square distance of the samples from the chosen values, (m,)."""
        spread_ = np.sqrt(np.mean((self.samples - self.values) ** 2, axis=0))
        return np.asarray(np.maximum(spread_, 1e-12))

    def draw(self, count: int, rng: np.random.Generator) -> tuple[Array, Array]:
        """Draw values (count, m) and the same in units of `scale` from the chosen ones.

        Deviations are scaled down to `JITTER` where they are larger: the runs have to show how the
        observables change with an earlier parameter, and a wide cloud would bury the dependence
        on the free parameters under it. The change is linear in what follows, so the full
        uncertainty is reached by extrapolation.
        """
        shrink = np.minimum(1.0, JITTER / self.scale)
        off = shrink * (self.samples[rng.integers(len(self.samples), size=count)] - self.values)
        return self.values + off, off / self.scale

    def moment(self) -> Array:
        """Return the second moment of the samples about the chosen values, in `scale`, (m, m)."""
        z = (self.samples - self.values) / self.scale
        return np.asarray(z.T @ z / len(z))

    def joined(self, keys: Sequence[tuple[str, str]], values: Array, samples: Array) -> Earlier:
        """Add the result of a further stage; its samples are paired at random with these."""
        rows = np.arange(len(samples)) % len(self.samples)
        return Earlier(
            keys=(*self.keys, *keys),
            values=np.concatenate([self.values, values]),
            samples=np.column_stack([self.samples[rows], samples]),
        )
