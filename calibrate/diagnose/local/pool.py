"""All runs of a diagnosis so far, and the surrogates they support."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from calibrate.arrays import Array
from calibrate.diagnose.local import design
from calibrate.diagnose.local import model as surrogate
from calibrate.diagnose.local.design import DesignOptions, Point
from calibrate.diagnose.local.model import LocalSurrogate
from calibrate.diagnose.problem import Problem, Runner
from calibrate.scales import forward
from liggghts_io import CaseResult, CaseSpec


@dataclass
class Pool:
    """Runs of all designs, per experiment.

    Attributes
    ----------
    problem : Problem
    runner : callable
        List of case descriptions to list of results.
    points, outputs : dict
        Experiment -> planned points and their observables, None for a failed run.
    failed : list of str
        Reasons of failed runs.
    designs, runs : int
    """

    problem: Problem
    runner: Runner
    points: dict[str, list[Point]] = field(default_factory=dict)
    outputs: dict[str, list[dict[str, float] | None]] = field(default_factory=dict)
    failed: list[str] = field(default_factory=list)
    designs: int = 0
    runs: int = 0

    def first(self, centre: Array, options: DesignOptions) -> None:
        """Run the first design of every experiment, candidates included."""
        self.designs += 1
        order = self.problem.order()
        self._run({e: design.plan(self.problem, e, centre, options) for e in order})

    def extend(self, centre: Array, options: DesignOptions) -> None:
        """Run a lighter design around a new centre."""
        self.designs += 1
        order = self.problem.order()
        self._run({e: design.extend(self.problem, e, centre, options) for e in order})

    def probe(self, u: Array, strengths: Mapping[str, float], options: DesignOptions) -> None:
        """Run one point with and without candidates in every experiment that they touch."""
        plans = {}
        for experiment in self.problem.order():
            on = self.problem.effects_in(experiment, strengths)
            if on:
                plans[experiment] = design.probe(u, {}, options) + design.probe(u, on, options)
        self._run(plans)

    def infill(self, u: Array, options: DesignOptions) -> None:
        """Run the base model at one point in every experiment."""
        self._run({e: design.probe(u, {}, options) for e in self.problem.order()})

    def _run(self, plans: Mapping[str, list[Point]]) -> None:
        specs: list[CaseSpec] = []
        for experiment, points in plans.items():
            specs += design.specify(self.problem, experiment, points)
        results = list(self.runner(specs))
        self.runs += len(specs)
        at = 0
        for experiment, points in plans.items():
            part = results[at : at + len(points)]
            at += len(points)
            outputs = [self._read(experiment, r) for r in part]
            self.points.setdefault(experiment, []).extend(points)
            self.outputs.setdefault(experiment, []).extend(outputs)

    def _read(self, experiment: str, result: CaseResult) -> dict[str, float] | None:
        """Observables of a run, or None with its reason noted."""
        reason = result.reason
        if result.status == "ok":
            needed, shown = self.problem.observed_in(experiment), result.observables
            absent = [o.quantity for o in needed if o.quantity not in shown]
            off = [
                f"{o.quantity} = {shown[o.quantity]:g} has no place on the scale '{o.scale}'"
                for o in needed
                if o.quantity in shown
                and not np.isfinite(forward(o.scale, np.array(shown[o.quantity])))
            ]
            if not absent and not off:
                return dict(shown)
            reason = f"the run does not show {', '.join(absent)}" if absent else "; ".join(off)
        self.failed.append(f"{experiment}: {reason}")
        return None

    def box(self) -> tuple[Array, Array]:
        """Bounding box of the base runs: outside it nothing is known, shape (d,) each."""
        u = np.array([p.u for points in self.points.values() for p in points])
        return u.min(axis=0), u.max(axis=0)

    def surrogates(self, half_width: float) -> dict[str, LocalSurrogate]:
        """Fit every experiment's surrogate around the middle of all runs."""
        low, high = self.box()
        return {
            e: surrogate.build(
                self.problem, e, points, self.outputs[e], 0.5 * (low + high), half_width
            )
            for e, points in self.points.items()
        }
