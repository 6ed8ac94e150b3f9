"""Measured against simulated, observable by observable, with every variance counted."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calibrate.diagnose.fit import Fit
from calibrate.diagnose.scores import frame, marginal
from calibrate.diagnose.stack import Stack
from calibrate.scales import backward, slope


@dataclass(frozen=True)
class Residual:
    """One row of the table.

    Attributes
    ----------
    name : str
    measured, simulated : float
        In the observable's unit; simulated at the fit, the surrogate's mean.
    measured_sd, simulated_sd : float
        Standard errors in the same unit; the second holds seed noise and surrogate error.
    z : float
        Measured minus simulated over both errors.
    z_left_out : float
        The same when this observable had no part in the fit: how far it lies from what all
        others predict. Parameters integrated out, the model linear around the fit.
    """

    name: str
    measured: float
    simulated: float
    measured_sd: float
    simulated_sd: float
    z: float
    z_left_out: float


def residuals(stack: Stack, fitted: Fit) -> list[Residual]:
    """Table of residuals at a fit.

    With K = V + J P^-1 J^T and e the residual at the prior's centre, the left-out residual of
    observable j is (K^-1 e)_j / sqrt((K^-1)_jj) (Rasmussen and Williams 2006, eq. 5.12).
    """
    lin = stack.linearise(fitted.u, fitted.strengths)
    here = frame(stack, fitted)
    inverse = np.linalg.inv(marginal(here.covariance, here.by_u))
    left_out = inverse @ here.residual / np.sqrt(np.diag(inverse))
    bench = stack.measured**2 + np.diag(stack.nuisance)
    own = np.diag(lin.surrogate)
    rows = []
    ordered = [o for e in stack.problem.order() for o in stack.problem.observed_in(e)]
    for k, one in enumerate(ordered):
        value = float(backward(one.scale, np.array(lin.mean[k])))
        rows.append(
            Residual(
                name=one.name,
                measured=one.value,
                simulated=value,
                measured_sd=float(np.sqrt(bench[k])) / slope(one.scale, one.value),
                simulated_sd=float(np.sqrt(own[k])) / slope(one.scale, value),
                z=float((stack.y[k] - lin.mean[k]) / np.sqrt(bench[k] + own[k])),
                z_left_out=float(left_out[k]),
            )
        )
    return rows
