"""A target of a stage as its surrogates predict it: an emulator for the common likelihood.

A number has one surrogate. A curve has one for each of its principal components; what they cut off
stays as variance.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calibrate.arrays import Array
from calibrate.emulator.components import Components, components_of
from calibrate.emulator.types import Emulator, Inputs, Prediction
from calibrate.staged.surrogates.samples import Quality, Samples
from calibrate.staged.surrogates.surface import Surrogate, fit_surrogate

__all__ = ["HeldErrors", "TargetSurrogate", "fit_target"]


@dataclass(frozen=True, eq=False)
class TargetSurrogate:
    """Surrogates of one target; predicts the mean over seeds, at the chosen earlier parameters.

    Attributes
    ----------
    parts : tuple of Surrogate
        One per component.
    components : Components
        How values at the L levels follow from them; a number is its own component.
    """

    parts: tuple[Surrogate, ...]
    components: Components

    def predict(self, inputs: Inputs) -> Prediction:
        """Return the expected values at n inputs, (n, L) on the transformed scale."""
        found = [part.predict(inputs.u) for part in self.parts]
        scores = np.column_stack([mean for mean, _ in found])
        variances = np.column_stack([variance for _, variance in found])
        mean = self.components.centre + scores @ self.components.basis.T
        if mean.shape[1] == 1:
            return Prediction(mean, variances, np.zeros((len(mean), 1, 0)))
        factors = self.components.basis[None] * np.sqrt(variances)[:, None, :]
        return Prediction(mean, np.tile(self.components.truncation, (len(mean), 1)), factors)

    @property
    def gradient(self) -> Array:
        """Change of each level per standard deviation of each earlier parameter, (L, m)."""
        gradients = np.array([part.gradient for part in self.parts])
        return np.asarray(self.components.basis @ gradients)

    @property
    def quality(self) -> Quality:
        """How well left-out runs are predicted; of a curve its first component."""
        return self.parts[0].quality

    @property
    def noise_sd(self) -> float:
        """Scatter of one run, of a curve that of the mean over its levels."""
        noise = np.array([part.quality.noise_sd for part in self.parts])
        return float(np.linalg.norm(self.components.basis.mean(axis=0) * noise))

    def average(self, u: Array) -> tuple[Array, Array]:
        """Return mean and variance, (n,), of the mean over the levels; a number is its own."""
        found = self.predict(Inputs.at(u))
        common = found.factors.mean(axis=1)
        own = found.variance.sum(axis=1) / found.mean.shape[1] ** 2
        return found.mean.mean(axis=1), own + np.sum(common**2, axis=1)


@dataclass(frozen=True, eq=False)
class HeldErrors:
    """An emulator that is everywhere as uncertain as it is at one point.

    Attributes
    ----------
    inner : Emulator
    errors : Prediction
        Of that point, one row.
    """

    inner: Emulator
    errors: Prediction

    def predict(self, inputs: Inputs) -> Prediction:
        """Return the expected outputs at n inputs."""
        mean = self.inner.predict(inputs).mean
        variance = np.tile(self.errors.variance, (len(mean), 1))
        return Prediction(mean, variance, np.tile(self.errors.factors, (len(mean), 1, 1)))


def fit_target(samples: Samples, seed: int) -> TargetSurrogate:
    """Fit the surrogates of a target.

    Parameters
    ----------
    samples : Samples
        Runs, y of shape (n, L).
    seed : int
        Seed of the search for the correlation lengths.

    Raises
    ------
    CalibrationError
        When there are too few points or the observable does not vary at all.
    """
    y = samples.y if len(samples.y) > 1 else samples.y[:, :1]  # the surrogate refuses so few
    components = components_of(y)
    columns = components.scores(y).T
    parts = [fit_surrogate(Samples(samples.x, one, samples.nuisance), seed) for one in columns]
    return TargetSurrogate(tuple(parts), components)
