"""Runs for the diagnosis: through a campaign with stored cases, cost announced beforehand."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Protocol, TypeAlias

import numpy as np

from liggghts_io import CaseResult, CaseSpec, experiment_of, read_curve

Levels: TypeAlias = Mapping[tuple[str, str], tuple[float, ...]]
"""Levels at which curves are read, by experiment and curve."""


def point_of(curve: str, level: float) -> str:
    """Return the name of a point of a curve, as an observable.

    Examples
    --------
    >>> point_of("mass_time", 50.0)
    'mass_time@50'
    """
    return f"{curve}@{level:g}"


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
    levels : mapping
        Levels at which curves are read, by experiment and curve.
    """

    campaign: Campaigning
    stored: Callable[[CaseSpec], CaseResult | None]
    announce: Callable[[str], None]
    workers: int = 1
    typical_s: float = 6.0
    levels: Levels = field(default_factory=dict)
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
        return [with_curves(found[repr(spec)], spec, self.levels) for spec in specs]

    def _noted(self, result: CaseResult, spec: CaseSpec) -> CaseResult:
        """Return the result; its duration helps to say how long others will take."""
        if result.wall_s > 0.0:
            self._seen.setdefault(spec.experiment, []).append(result.wall_s)
        return result

    def _duration(self, spec: CaseSpec) -> float:
        seen = self._seen.get(spec.experiment)
        return float(np.median(seen)) if seen else self.typical_s


def with_curves(result: CaseResult, spec: CaseSpec, levels: Levels) -> CaseResult:
    """Add the points of a run's curves that are asked for.

    A run whose curve ends early keeps the points that it has.

    Parameters
    ----------
    result : CaseResult
    spec : CaseSpec
        Its case.
    levels : mapping
        By experiment and curve.

    Raises
    ------
    CaseError
        If the file with a curve was changed since the run.
    """
    points: dict[str, float] = {}
    for curve in experiment_of(spec).curves:
        at = levels.get((spec.experiment, curve.name), ())
        if at and result.status == "ok":
            values = read_curve(result, replace(curve, levels=at))
            points |= {point_of(curve.name, x): float(y) for x, y in zip(at, values, strict=True)}
    known = {name: value for name, value in points.items() if math.isfinite(value)}
    return replace(result, observables={**known, **result.observables}) if known else result
