"""Effect twins: runs that differ from a finished one by a single effect, so that luck cancels.

A few of each effect first; more only of those that the data could show at all.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from calibrate.causes.hypotheses import Board
from calibrate.causes.visibility import Visibility
from calibrate.questions.core.forms import Form, FormKey, Switch
from calibrate.questions.core.runs import Runs
from liggghts_io import CaseSpec

__all__ = ["SCREENED", "TWINS", "twin_cases", "worth_twins"]

REACH: Final = 3.0
"""Strength of effect twins, in ordinary strengths; half of what is considered."""
SCREENED: Final = 4
"""Points of each emulator at which each effect is switched on, to see whether it can be seen."""
TWINS: Final = 12
"""Points for an effect that can be seen."""
DOUBTFUL: Final = 2.0
"""A cause that needs more than this many times its largest strength cannot be seen; one that needs
less may be seen with a signature that is better known."""


def twin_cases(
    forms: Mapping[FormKey, Form], runs: Runs, effects: Collection[str], count: int
) -> list[CaseSpec]:
    """Return cases that differ from finished runs by one effect only.

    Parameters
    ----------
    forms : mapping
        Of the study with all effects, see `calibrate.causes.studies.from_study.with_effects`.
    runs : Runs
        Of the base model. Points and seeds are theirs.
    effects : collection of str
        Which to switch on.
    count : int
        Points of each emulator, at most `TWINS`; fewer are the first of more.
    """
    found = []
    good = (runs.table["status"] == "ok").to_numpy()
    for key, form in forms.items():
        plain = [runs.specs[i] for i in np.flatnonzero(runs.of(key) & good)]
        plain = [spec for spec in plain if not _on(spec, effects)]
        for number, switch in enumerate(form.switches):
            if switch.name not in effects:
                continue
            step = max(len(plain) // TWINS, 1)
            some = plain[number % step :: step][:count]
            found += [
                replace(spec, effects={**spec.effects, switch.name: strength})
                for spec, strength in zip(some, _strengths(switch), strict=False)
            ]
    return found


def _on(spec: CaseSpec, effects: Collection[str]) -> bool:
    return any(spec.effects.get(name, 0.0) != 0.0 for name in effects)


def _strengths(switch: Switch) -> list[float]:
    """Return strengths of twins; the ends take turns, and so do a half and the whole reach."""
    reach = REACH * switch.step
    high, low = min(reach, switch.high), max(-reach, switch.low)
    ends = [end for end in (high, low) if end != 0.0]
    return [ends[k % len(ends)] * (0.5 if k // len(ends) % 2 else 1.0) for k in range(TWINS)]


def worth_twins(board: Board, seen: Visibility) -> tuple[str, ...]:
    """Return the effects that the data could show in one place or everywhere.

    Parameters
    ----------
    board : Board
    seen : Visibility
        With the signatures of a few twins, so that what just misses being visible is kept.
    """
    found = [
        one.effect
        for one in board.candidates
        if seen.of(one.name).detectable <= DOUBTFUL * one.limit
    ]
    return tuple(dict.fromkeys(found))
