"""From a study and parameters to case specifications."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from calibrate.study.model import Study, Target
from liggghts_io import CaseSpec
from liggghts_io.effects import EFFECTS

__all__ = ["bench", "case_spec", "middle", "planned"]


def bench(targets: Sequence[Target]) -> list[tuple[str, str]]:
    """Return the experiments that targets need, as (experiment, surface) without repeats."""
    return list(dict.fromkeys((t.experiment, t.surface) for t in targets))


def _acting(study: Study, experiment: str) -> dict[str, float]:
    """Return the effects of a study that act in an experiment."""
    return {
        name: strength
        for name, strength in study.effects.items()
        if EFFECTS[name].acts_in(experiment)
    }


def case_spec(
    study: Study, place: tuple[str, str], parameters: Mapping[str, float], seed: int
) -> CaseSpec:
    """Return the case of one experiment at given contact parameters.

    Parameters
    ----------
    study : Study
        Particle, scale, engine, apparatus and effects.
    place : (str, str)
        Experiment and surface.
    parameters : mapping
        All six contact parameters.
    seed : int
        Seed of the insertion.
    """
    experiment, surface = place
    return CaseSpec(
        experiment=experiment,
        particle=study.bulk.particle,
        surface=surface,
        scale=study.scale,
        # Ten digits are more than any parameter means and keep case ids stable across platforms.
        parameters={name: float(f"{value:.10g}") for name, value in sorted(parameters.items())},
        apparatus=dict(study.apparatus.get(experiment, {})),
        effects=_acting(study, experiment),
        seed=seed,
        engine=study.engine,
    )


def middle(study: Study) -> dict[str, float]:
    """Return contact parameters in the middle of their ranges, those of no stage as fixed."""
    ranges = {name: bounds for stage in study.stage for name, bounds in stage.free.items()}
    return {**study.fixed, **{name: 0.5 * (low + high) for name, (low, high) in ranges.items()}}


def planned(study: Study) -> dict[tuple[str, str], int]:
    """Return how many runs a calibration asks for, by experiment and surface."""
    runs = dict.fromkeys(bench(study.target), study.check_seeds)
    for stage in study.stage:
        for place in bench([study.target_named(name) for name in stage.targets]):
            runs[place] += stage.points + stage.repeats + stage.infill
    return runs
