"""Experiments as LIGGGHTS scripts: case directories, engine runner, observables, effects.

Names are loaded when they are asked for: who wants to know of one thing does not wait for all.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from liggghts_io.case.directory import free_directory, load_spec, write_case
    from liggghts_io.case.execution import execute, post_case, run_case
    from liggghts_io.case.failure import RETRYABLE, Failure
    from liggghts_io.case.other_code import OtherCode, other_code
    from liggghts_io.case.results import (
        CaseResult,
        is_final,
        load_result,
        read_curve,
        read_table,
        stored_result,
    )
    from liggghts_io.case.spec import CaseSpec, case_id, experiment_of
    from liggghts_io.errors import CaseError
    from liggghts_io.experiments import OwnExperiment, experiment_files, read_experiment
    from liggghts_io.materials import Particle
    from liggghts_io.particles import particle_named, read_particles
    from liggghts_io.pictures.render import Look, chart_case, render_case, scene_of_case

__all__ = [
    "RETRYABLE",
    "CaseError",
    "CaseResult",
    "CaseSpec",
    "Failure",
    "Look",
    "OtherCode",
    "OwnExperiment",
    "Particle",
    "case_id",
    "chart_case",
    "execute",
    "experiment_files",
    "experiment_of",
    "free_directory",
    "is_final",
    "load_result",
    "load_spec",
    "other_code",
    "particle_named",
    "post_case",
    "read_curve",
    "read_experiment",
    "read_particles",
    "read_table",
    "render_case",
    "run_case",
    "scene_of_case",
    "stored_result",
    "write_case",
]

_PLACES: Final = {
    "RETRYABLE": "case.failure",
    "CaseError": "errors",
    "CaseResult": "case.results",
    "CaseSpec": "case.spec",
    "Failure": "case.failure",
    "Look": "pictures.render",
    "OtherCode": "case.other_code",
    "OwnExperiment": "experiments",
    "Particle": "materials",
    "case_id": "case.spec",
    "chart_case": "pictures.render",
    "execute": "case.execution",
    "experiment_files": "experiments",
    "experiment_of": "case.spec",
    "free_directory": "case.directory",
    "is_final": "case.results",
    "load_result": "case.results",
    "load_spec": "case.directory",
    "other_code": "case.other_code",
    "particle_named": "particles",
    "post_case": "case.execution",
    "read_curve": "case.results",
    "read_experiment": "experiments",
    "read_particles": "particles",
    "read_table": "case.results",
    "render_case": "pictures.render",
    "run_case": "case.execution",
    "scene_of_case": "pictures.render",
    "stored_result": "case.results",
    "write_case": "case.directory",
}
"""Module of each name."""


def __getattr__(name: str) -> Any:
    """Return what a name stands for (PEP 562)."""
    if name not in _PLACES:
        msg = f"module {__name__!r} has no attribute {name!r}"
        raise AttributeError(msg)
    found = getattr(import_module(f"{__name__}.{_PLACES[name]}"), name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return sorted(globals() | _PLACES)
