"""A study of bulkcal with planted numbers, and a runner of its cases that counts."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final, NamedTuple

import pandas as pd

from benchmarks.peers.apparatus import PLACES, RANGES, SCALE, Place
from benchmarks.peers.problem import Problem
from calibrate.runs.campaign import run_table
from calibrate.runs.runner import Runner
from calibrate.study.data import StudyData, load_data
from calibrate.study.resources import bundled_particles
from liggghts_io import CaseResult, CaseSpec, case_id
from liggghts_io.materials import GLUED, kind_of

SPEED: Final = 1e7
"""Particle-steps per second that are said of every run: equal on every machine and day."""
_WALL: Final = "_pw"
_UNITS: Final = {"angle_deg": "deg", "t100_s": "s"}


class Planted(NamedTuple):
    """One measured number of a study.

    Attributes
    ----------
    name : str
        Of the target, a word that no other has.
    material, wall, experiment, observable : str
        The wall is a label; "glued" is the glued plate.
    value, error : float
    """

    name: str
    material: str
    wall: str
    experiment: str
    observable: str
    value: float
    error: float


def planted_study(
    targets: Sequence[Planted],
    seed: int,
    design: Mapping[str, float],
    *,
    held: Mapping[str, float] | None = None,
    stages: str = "",
) -> StudyData:
    """Return a study with all parameters that act free between `RANGES`.

    Parameters
    ----------
    targets : sequence of Planted
    seed : int
        Of its runs and draws.
    design : mapping
        Entries of its table [design].
    held : mapping, optional
        Values of parameters before a stage frees them.
    stages : str
        Its tables [[stage]].

    Returns
    -------
    StudyData
        Friction and restitution at a wall belong to the wall, whoever lies on it.
    """
    lines = ['name = "planted"', 'title = "Planted"', "[run]", f'scale = "{SCALE}"']
    lines += [f"seed = {seed}", "[design]", *(f"{k} = {v}" for k, v in design.items())]
    for material in dict.fromkeys(one.material for one in targets):
        lines += ["[[material]]", f'name = "{material}"']
    for wall in dict.fromkeys(one.wall for one in targets):
        kind = GLUED if wall == GLUED else "flat"
        lines += ["[[surface]]", f'name = "{wall}"', f'kind = "{kind}"']
    for experiment in dict.fromkeys(one.experiment for one in targets):
        apparatus = ", ".join(f"{k} = {v}" for k, v in _place(experiment, "flat").apparatus.items())
        lines += ["[[experiment]]", f'name = "{experiment}"', f"apparatus = {{ {apparatus} }}"]
    for one in targets:
        lines += _target(one)
    bare = any(one.wall != GLUED for one in targets)
    for name, (low, high) in RANGES.items():
        if name.endswith(_WALL) and not bare:
            continue
        scope = "surface" if name.endswith(_WALL) else "material"
        lines += [f"[parameter.{name}]", f"range = [{low}, {high}]", f'scope = "{scope}"']
        lines += [f"value = {held[name]}"] if held and name in held else []
    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(bundled_particles(), folder)
        path = Path(folder) / "study.toml"
        path.write_text("\n".join([*lines, stages]) + "\n", encoding="utf-8")
        return load_data(path)


def _target(one: Planted) -> list[str]:
    words = {
        "name": one.name,
        "material": one.material,
        "surface": one.wall,
        "experiment": one.experiment,
        "observable": one.observable,
        "unit": _UNITS.get(one.observable, "g"),
    }
    entries = [f'{key} = "{word}"' for key, word in words.items()]
    return ["[[target]]", *entries, f"value = {one.value!r}", f"se = {one.error!r}"]


def _place(experiment: str, kind: str) -> Place:
    """Return where an experiment is done on a kind of wall."""
    return next(
        place
        for place in PLACES.values()
        if (place.experiment, kind_of(place.surface)) == (experiment, kind)
    )


def counting_runner(problem: Problem) -> Runner:
    """Return what runs the cases of a planted study, every run counted by the problem.

    The duration that the table says of a run is what it costs in particle-steps, so that a method
    which weighs durations answers equally on every machine.
    """

    def run(specs: Sequence[CaseSpec], label: str) -> pd.DataFrame:
        del label
        return run_table(specs, [_run(problem, spec) for spec in specs])

    return run


def _run(problem: Problem, spec: CaseSpec) -> CaseResult:
    place = _place(spec.experiment, kind_of(spec.surface))
    found = problem.run(place._replace(material=spec.particle.name), spec.parameters, spec.seed)
    status, reason = ("ok", "") if found.observables else ("failed", "no observables")
    seconds = found.particle_steps / SPEED
    return CaseResult(case_id(spec), Path(), status, reason, found.observables, seconds)
