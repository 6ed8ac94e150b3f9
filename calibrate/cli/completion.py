"""What the Tab key offers: names that a registry holds, and pairs that begin with one."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import typer

from calibrate.executor_names import DASK_LOCAL, JOB_QUEUES, LOCAL
from liggghts_io.case.runner import ENGINES
from liggghts_io.effects import effects_in
from liggghts_io.experiments import EXPERIMENTS, SCALES
from liggghts_io.materials import CONTACT_PARAMETERS, SURFACES

__all__ = [
    "apparatus_pairs",
    "effect_pairs",
    "engines",
    "executors",
    "experiments",
    "offer",
    "parameter_pairs",
    "scales",
    "surfaces",
]


def offer(known: Iterable[str], end: str = "") -> Callable[[str], list[str]]:
    """Return a function that completes known names.

    Parameters
    ----------
    known : iterable of str
    end : str
        Put behind each.
    """
    names = [f"{name}{end}" for name in known]

    def beginning_so(incomplete: str) -> list[str]:
        return [name for name in names if name.startswith(incomplete)]

    return beginning_so


experiments = offer(EXPERIMENTS)
surfaces = offer(SURFACES)
scales = offer(SCALES)
engines = offer(ENGINES)
executors = offer((LOCAL, DASK_LOCAL, *JOB_QUEUES, "dask://"))
parameter_pairs = offer(CONTACT_PARAMETERS, "=")


def apparatus_pairs(ctx: typer.Context, incomplete: str) -> list[str]:
    """Return the apparatus parameters of the experiment that the command line names."""
    names = [one.name for word in _named(ctx) for one in EXPERIMENTS[word].parameters]
    return offer(dict.fromkeys(names), "=")(incomplete)


def effect_pairs(ctx: typer.Context, incomplete: str) -> list[str]:
    """Return the effects that act in the experiment that the command line names."""
    names = [name for word in _named(ctx) for name in effects_in(EXPERIMENTS[word])]
    return offer(dict.fromkeys(names), "=")(incomplete)


def _named(ctx: typer.Context) -> list[str]:
    """Return the experiment of an unfinished command line, or all where it names none."""
    words = [str(ctx.params.get("experiment")), *ctx.args]
    return [word for word in words if word in EXPERIMENTS][:1] or list(EXPERIMENTS)
