"""Experiments as LIGGGHTS scripts: case directories, engine runner, observables, effects."""

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
