"""Runs with a leading cause near the strength that was found.

Where the engine with the cause does something else than was expected of it, what counts is what it
does near the strength found: twins are made there, at the runs that lie nearest to the posterior.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from scipy.spatial.distance import cdist

from calibrate.arrays import Array
from calibrate.causes.diagnosis import Diagnosis
from calibrate.causes.studies.twins import FEWEST, GOLDEN
from calibrate.questions.core.forms import Form, FormKey, Switch
from calibrate.questions.core.from_study import form_key
from calibrate.questions.core.runs import Runs
from calibrate.study.model import Study
from liggghts_io import CaseSpec
from liggghts_io.effects import Effect

__all__ = ["NEAR", "Near", "near_cases", "nearer"]

NEAR: Final = 12
"""Twins near the strength found, in each emulator, as many as a cause has at most before."""
REACH: Final = 0.5
"""Part of a strength by which those of its twins may differ from it, at first."""


@dataclass(frozen=True)
class Near:
    """About which strength a cause is looked at.

    Attributes
    ----------
    strength : float
        In the effect's unit.
    reach : float
        Part of it by which the strengths of twins may differ.
    """

    strength: float
    reach: float

    @property
    def ends(self) -> tuple[float, float]:
        """Lowest and highest strength."""
        low, high = sorted(self.strength * (1.0 + side * self.reach) for side in (-1.0, 1.0))
        return low, high

    def strengths(self, switch: Switch, count: int) -> Array:
        """Return strengths of twins between the ends and within the limits, (count,)."""
        low, high = np.clip(self.ends, switch.low, switch.high)
        return np.asarray(low + (high - low) * (GOLDEN * np.arange(1, count + 1) % 1.0))

    def holds(self, strengths: Array) -> Array:
        """Whether each strength is about it, bool as they are."""
        low, high = self.ends
        return np.asarray((strengths >= low) & (strengths <= high))


def nearer(
    found: Diagnosis, before: Mapping[str, Near], effects: Mapping[str, Effect]
) -> dict[str, Near]:
    """Return about which strengths to look next: closer, where the last ones held what is found.

    Parameters
    ----------
    found : Diagnosis
        With leading causes.
    before : mapping
        By effect.
    effects : mapping
        By name; instruments cost no run and are read at many strengths as it is.
    """
    new = dict(before)
    for one in found.board.members(found.leading):
        strength, old = found.strength(one.name, found.leading), before.get(one.effect)
        reach = REACH
        if old is not None:
            inside = bool(old.holds(np.array(strength)))
            reach = 0.5 * old.reach if inside else old.reach
        if effects[one.effect].needs_runs and not one.switch:
            # Three digits: what differs in the last ones asks for the same runs.
            new[one.effect] = Near(float(f"{strength:.3g}"), reach)
    return new


def near_cases(
    study: Study,
    forms: Mapping[FormKey, Form],
    runs: Runs,
    found: Diagnosis,
    near: Mapping[str, Near],
    most: int,
) -> list[CaseSpec]:
    """Return twins of the leading causes near their strengths, at runs near the posterior.

    Parameters
    ----------
    study : Study
    forms : mapping
        Of the study with all effects.
    runs : Runs
        Of the base model.
    found : Diagnosis
    near : mapping
        By effect.
    most : int
        Runs that may be made; none are where that is too few to learn from.
    """
    values = found.samples(found.leading)[0]
    acting: dict[tuple[FormKey, int], list[Array]] = {}
    for one in found.board.members(found.leading):
        if one.effect in near:
            for k, column in one.acts:
                at = acting.setdefault((form_key(study, study.places[k]), column), [])
                at.append(found.board.problem.places[k].inputs(values).u)
    each = min(NEAR, most // max(len(acting), 1))
    cases: list[CaseSpec] = []
    if each < FEWEST:
        return cases
    for (key, column), u in acting.items():
        form = forms[key]
        switch = form.switches[column]
        plain = _nearest(runs, form, np.vstack(u), each)
        strengths = near[switch.name].strengths(switch, len(plain))
        cases += [
            replace(spec, effects={**spec.effects, switch.name: float(x)})
            for spec, x in zip(plain, strengths, strict=True)
        ]
    return cases


def _nearest(runs: Runs, form: Form, draws: Array, count: int) -> Sequence[CaseSpec]:
    """Return the runs of a form that lie nearest to any of many draws."""
    good = (runs.table["status"] == "ok").to_numpy()
    specs = [runs.specs[i] for i in np.flatnonzero(runs.of(form.key) & good)]
    u = np.array([form.place_in(spec)[0] for spec in specs])
    away = cdist(u, draws).min(axis=1)
    return [specs[i] for i in np.argsort(away, kind="stable")[:count]]
