"""Runs for the diagnosis: through a campaign with stored cases, cost announced beforehand."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from io import StringIO
from typing import Protocol

import numpy as np
import pandas as pd

from calibrate.study.curve_kinds import MASS_TIME
from calibrate.study.measured.curves import first_time
from liggghts_io import CaseResult, CaseSpec, read_table
from liggghts_io.experiments import EXPERIMENTS


def time_at(level: float) -> str:
    """Return the name of the time at which a mass [g] is reached, as an observable.

    Examples
    --------
    >>> time_at(50.0)
    't50_s'
    """
    return f"t{level:g}_s"


class Campaigning(Protocol):
    """What is needed of a campaign: run these, report under that label."""

    def results(self, specs: Sequence[CaseSpec], label: str) -> list[CaseResult]:
        """Run cases and return their results in order."""


@dataclass
class StoredRunner:
    """Runner of the diagnosis on top of a campaign.

    Attributes
    ----------
    campaign : Campaigning
        Runs cases and stores them.
    stored : callable
        Stored result of a case, or None.
    announce : callable
        Receives one line before missing runs start.
    workers : int
        Processes of the campaign, for the estimate.
    typical_s : float
        Duration of a run as long as none has been seen.
    levels : tuple of float
        Masses at which mass-time curves are read [g].
    """

    campaign: Campaigning
    stored: Callable[[CaseSpec], CaseResult | None]
    announce: Callable[[str], None]
    workers: int = 1
    typical_s: float = 6.0
    levels: tuple[float, ...] = MASS_TIME.levels
    _seen: dict[str, list[float]] = field(default_factory=dict)

    def __call__(self, specs: Sequence[CaseSpec]) -> list[CaseResult]:
        """Run what is missing and return all results in order."""
        unique = {repr(spec): spec for spec in specs}
        found: dict[str, CaseResult] = {}
        for key, spec in unique.items():
            result = self.stored(spec)
            if result is not None:
                found[key] = self._noted(result, spec)
        missing = [spec for key, spec in unique.items() if key not in found]
        if missing:
            cost = sum(self._duration(s) for s in missing) / max(self.workers, 1)
            self.announce(
                f"{len(missing)} of {len(unique)} runs are missing: about {cost / 60.0:.1f} min "
                f"on {self.workers} processes"
            )
            fresh = self.campaign.results(missing, "diagnosis")
            for spec, result in zip(missing, fresh, strict=True):
                found[repr(spec)] = self._noted(result, spec)
        return [with_curve(found[repr(spec)], spec.experiment, self.levels) for spec in specs]

    def _noted(self, result: CaseResult, spec: CaseSpec) -> CaseResult:
        """Return the result; its duration helps to say how long others will take."""
        if result.wall_s > 0.0:
            self._seen.setdefault(spec.experiment, []).append(result.wall_s)
        return result

    def _duration(self, spec: CaseSpec) -> float:
        seen = self._seen.get(spec.experiment)
        return float(np.median(seen)) if seen else self.typical_s


def with_curve(
    result: CaseResult, experiment: str, levels: Sequence[float] = MASS_TIME.levels
) -> CaseResult:
    """Add the times at fixed masses from the run's mass-time curve, where it has one.

    A run whose curve ends early keeps the points that it has.

    Parameters
    ----------
    result : CaseResult
    experiment : str
        Name of the experiment, which says in which table its curve is.
    levels : sequence of float
        Masses [g].

    Raises
    ------
    CaseError
        If the file with the curve was changed since the run.
    """
    name = EXPERIMENTS[experiment].curve
    if not name or result.status != "ok" or name not in result.tables:
        return result
    table = pd.read_csv(StringIO(read_table(result, name)))
    time = table["time_s"].to_numpy(dtype=np.float64)
    mass = table["mass_g"].to_numpy(dtype=np.float64)
    times = {time_at(level): first_time(time, mass, level) for level in levels}
    known = {k: v for k, v in times.items() if math.isfinite(v)}
    # The engine's own t100_s stays: it is the observable that the calibration uses.
    return replace(result, observables={**known, **result.observables})
