"""What the Tab key offers: names that a registry holds, and pairs that begin with one."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import typer

from liggghts_io.case.runner import ENGINES
from liggghts_io.effects import EFFECTS
from liggghts_io.experiments import EXPERIMENTS, SCALES
from liggghts_io.materials import CONTACT_PARAMETERS, SURFACES

__all__ = [
    "apparatus_pairs",
    "effect_pairs",
    "engines",
    "experiments",
    "parameter_pairs",
    "scales",
    "surfaces",
]


def _offer(known: Iterable[str], end: str = "") -> Callable[[str], list[str]]:
    names = [f"{name}{end}" for name in known]

    def offer(incomplete: str) -> list[str]:
        return [name for name in names if name.startswith(incomplete)]

    return offer


experiments = _offer(EXPERIMENTS)
surfaces = _offer(SURFACES)
scales = _offer(SCALES)
engines = _offer(ENGINES)
parameter_pairs = _offer(CONTACT_PARAMETERS, "=")


def apparatus_pairs(ctx: typer.Context, incomplete: str) -> list[str]:
    """Return the apparatus parameters of the experiment that the command line names."""
    experiment = EXPERIMENTS.get(str(ctx.params.get("experiment")))
    parameters = experiment.parameters if experiment else ()
    return _offer([one.name for one in parameters], "=")(incomplete)


def effect_pairs(ctx: typer.Context, incomplete: str) -> list[str]:
    """Return the effects that act in the experiment that the command line names."""
    experiment = str(ctx.params.get("experiment"))
    return _offer([e.name for e in EFFECTS.values() if e.acts_in(experiment)], "=")(incomplete)
