"""Sobol indices of everything that is emulated, over the ranges of the study."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.emulator.part import Part
from calibrate.emulator.process import Process
from calibrate.emulator.types import Inputs
from calibrate.inference.problem import Place as Seen
from calibrate.inference.sensitivity import Indices, sobol
from calibrate.inference.space import Space
from calibrate.questions.core.emulate import Emulators
from calibrate.questions.core.forms import Emulated
from calibrate.questions.core.from_study import form_key
from calibrate.questions.core.problem import inputs_at, seen_at, space_of
from calibrate.questions.sensitivity.responses import component_name, kept_components
from calibrate.study.data import StudyData
from calibrate.study.places import Place

__all__ = ["Explained", "Share", "shares_of"]

SENSITIVITY: Final = 6
"""Keeps these draws apart from those of other questions to a study."""
STILL: Final = 1e-12
"""Variance over that of the runs below which an output does not change."""


@dataclass(frozen=True)
class Share:
    """How much of a number's variance over the ranges an unknown causes.

    Attributes
    ----------
    where, name : str
        Place in words; observable, curve or component of a curve.
    parameter : str
    first, total : float
    first_span, total_span : (float, float)
        90 % intervals, error of sampling and of the emulator together.
    made : float
        Total index that the emulator's error alone makes in one of ten cases.
    """

    where: str
    name: str
    parameter: str
    first: float
    total: float
    first_span: tuple[float, float]
    total_span: tuple[float, float]
    made: float

    @property
    def seen(self) -> bool:
        """Whether the index is larger than what the emulator's error makes."""
        return self.total > self.made


@dataclass(frozen=True)
class Explained:
    """How well an output is known over the ranges.

    Attributes
    ----------
    where, name : str
    runs : int
        Behind the emulator.
    q2 : float
        Share of the variance of left-out runs that is predicted, seed noise in it.
    error_share : float
        Variance of the emulator's error over that of what it emulates.
    noise : float
        Variance of one run by its seed over the variance that the parameters cause.
    """

    where: str
    name: str
    runs: int
    q2: float
    error_share: float
    noise: float


def shares_of(
    data: StudyData, emulators: Emulators, places: Mapping[Place, str]
) -> tuple[list[Share], list[Explained]]:
    """Return the indices of every target's output at every place, and how well it is known.

    Inputs are uniform over their ranges, on the scale on which the study searches them; ties and
    priors do not count.

    Parameters
    ----------
    data : StudyData
    emulators : Emulators
    places : mapping
        Where to look, in words, from `distinct_places`.
    """
    study = data.study
    space = space_of(study)
    rng = np.random.default_rng([study.run.seed, SENSITIVITY])
    shares: list[Share] = []
    known: list[Explained] = []
    for place, where in places.items():
        trained = emulators.trained[form_key(study, place)]
        seen = seen_at(study, space, place, trained.form, trained.emulator)
        free = _Free(space, seen)
        if not free.columns:
            continue
        for output, part in zip(trained.form.outputs, trained.emulator.parts, strict=True):
            for name, found, process in _outputs(output, part, free, rng):
                shares += _rows(where, name, found, free)
                known.append(_explained(where, name, found, process, part))
    return shares, known


class _Free:
    """What varies at a place, as points of a unit cube.

    Parameters
    ----------
    space : Space
    seen : Place
        With the sources of its emulator's inputs.
    """

    def __init__(self, space: Space, seen: Seen) -> None:
        self._space, self._seen = space, seen
        sources = (*seen.u, *seen.strengths)
        self.columns = sorted({s.index for s in sources if s.index is not None})

    @property
    def names(self) -> list[str]:
        """Parameter of each column."""
        return [self._space.unknowns[k].name for k in self.columns]

    def indices(self, process: Process, rng: np.random.Generator) -> Indices | None:
        """Return the indices of one emulated number; None where it does not change."""

        def inputs(cube: Array) -> Inputs:
            units = np.full((len(cube), self._space.size), 0.5)
            units[:, self.columns] = cube
            return inputs_at(self._seen, self._space.values_of(units))

        spread = float(np.var(process.runs.y))
        probe = process.predict(inputs(rng.random((256, len(self.columns)))))[0]
        if float(np.var(probe)) <= STILL * max(spread, STILL):
            return None
        return sobol(
            lambda cube: process.predict(inputs(cube))[0],
            lambda cube, count: process.errors(inputs(cube), count, rng),
            len(self.columns),
            rng,
        )


def _outputs(
    output: Emulated, part: Part, free: _Free, rng: np.random.Generator
) -> list[tuple[str, Indices, Process]]:
    """Return what is looked at of an output: a number, or the components of a curve that matter."""
    if not part.is_curve:
        found = free.indices(part.processes[0], rng)
        return [] if found is None else [(output.name, found, part.processes[0])]
    kept = [(k, part.processes[k]) for k in kept_components(part.components, part.y)]
    each = [(component_name(output, k), free.indices(one, rng), one) for k, one in kept]
    return [(name, found, one) for name, found, one in each if found is not None]


def _rows(where: str, name: str, found: Indices, free: _Free) -> list[Share]:
    return [
        Share(
            where, name, parameter,
            float(found.first[k]), float(found.total[k]),
            (float(found.first_span[k, 0]), float(found.first_span[k, 1])),
            (float(found.total_span[k, 0]), float(found.total_span[k, 1])),
            float(found.made[k]),
        )
        for k, parameter in enumerate(free.names)
    ]  # fmt: skip


def _explained(where: str, name: str, found: Indices, process: Process, part: Part) -> Explained:
    y = process.runs.y[process.runs.believed]
    left = process.left_out
    missed = float(np.mean((left.y - left.mean)[process.runs.believed] ** 2))
    return Explained(
        where,
        name,
        len(part.y),
        1.0 - missed / float(np.var(y)),
        found.error_share,
        process.form.noise / found.variance,
    )
