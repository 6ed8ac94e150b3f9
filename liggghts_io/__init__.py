"""Experiments as LIGGGHTS scripts: case directories, engine runner, observables, effects."""

from liggghts_io.case.directory import load_spec, write_case
from liggghts_io.case.results import CaseResult, execute, load_result, post_case, run_case
from liggghts_io.case.spec import CaseSpec, case_id
from liggghts_io.errors import CaseError
from liggghts_io.materials import Particle
from liggghts_io.particles import particle_named, read_particles
from liggghts_io.pictures.render import chart_case, render_case

__all__ = [
    "CaseError",
    "CaseResult",
    "CaseSpec",
    "Particle",
    "case_id",
    "chart_case",
    "execute",
    "load_result",
    "load_spec",
    "particle_named",
    "post_case",
    "read_particles",
    "render_case",
    "run_case",
    "write_case",
]
