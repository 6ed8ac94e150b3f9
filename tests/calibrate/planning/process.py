"""A process with given correlation length and noise, in ten lines of linear algebra."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from calibrate.emulator.types import Inputs, Prediction


@dataclass(frozen=True)
class FixedProcess:
    """Gaussian process of M independent outputs with unit variance; squared exponential."""

    u: np.ndarray
    y: np.ndarray
    length: float = 0.3
    noise: float = 1e-4

    def _kernel(self, a: np.ndarray, b: np.ndarray) -> np.ndarray:
        distance = np.sum((a[:, None] - b[None]) ** 2, axis=2)
        return np.exp(-0.5 * distance / self.length**2)

    def covariance(self, a: np.ndarray, b: np.ndarray) -> np.ndarray:
        """Return the covariance of expected outputs."""
        own = self._kernel(self.u, self.u) + self.noise * np.eye(len(self.u))
        known = self._kernel(a, self.u) @ np.linalg.solve(own, self._kernel(self.u, b))
        return self._kernel(a, b) - known

    def predict(self, inputs: Inputs) -> Prediction:
        """Return mean and variance."""
        own = self._kernel(self.u, self.u) + self.noise * np.eye(len(self.u))
        mean = self._kernel(inputs.u, self.u) @ np.linalg.solve(own, self.y)
        variance = np.diag(self.covariance(inputs.u, inputs.u))
        return Prediction(
            mean, np.tile(variance[:, None], mean.shape[1]), np.zeros((*mean.shape, 0))
        )

    def weighted_reduction(self, candidates: Inputs, at: Inputs, weights: np.ndarray) -> np.ndarray:
        """Return the fall of the weighted variance from a run at each candidate."""
        cross = self.covariance(candidates.u, at.u) ** 2
        own = np.diag(self.covariance(candidates.u, candidates.u)) + self.noise
        return (cross / own[:, None]) @ weights.sum(axis=1)

    def updated(self, inputs: Inputs, y: np.ndarray) -> FixedProcess:
        """Return the process with further runs."""
        return replace(self, u=np.vstack([self.u, inputs.u]), y=np.vstack([self.y, y]))
