"""What the Tab key offers: names that a registry holds, and pairs that begin with one."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import typer

from calibrate.executor_names import DASK_LOCAL, JOB_QUEUES, LOCAL
from liggghts_io.case.runner import ENGINES
from liggghts_io.effects import EFFECTS
from liggghts_io.experiments import EXPERIMENTS, SCALES
from liggghts_io.materials import CONTACT_PARAMETERS, SURFACES

__all__ = [
    "apparatus_pairs",
    "effect_pairs",
    "engines",
    "executors",
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
executors = _offer((LOCAL, DASK_LOCAL, *JOB_QUEUES, "dask://"))
parameter_pairs = _offer(CONTACT_PARAMETERS, "=")


def apparatus_pairs(ctx: typer.Context, incomplete: str) -> list[str]:
    """Return the apparatus parameters of the experiment that the command line names."""
    names = [one.name for word in _named(ctx) for one in EXPERIMENTS[word].parameters]
    return _offer(dict.fromkeys(names), "=")(incomplete)


def effect_pairs(ctx: typer.Context, incomplete: str) -> list[str]:
    """Return the effects that act in the experiment that the command line names."""
    names = [e.name for word in _named(ctx) for e in EFFECTS.values() if e.acts_in(word)]
    return _offer(dict.fromkeys(names), "=")(incomplete)


def _named(ctx: typer.Context) -> list[str]:
    """Return the experiment of an unfinished command line, or all where it names none."""
    words = [str(ctx.params.get("experiment")), *ctx.args]
    return [word for word in words if word in EXPERIMENTS][:1] or list(EXPERIMENTS)
