"""Effect twins: runs that differ from a finished one by a single effect, so that luck cancels.

A few of each effect first; more only of those that the data could show at all.
"""

from __future__ import annotations

import itertools
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
"""Points for an effect that can be seen, where nobody asks for another number."""
GOLDEN: Final = 0.6180339887498949
"""Fraction whose multiples are spread most evenly, however many there are."""
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
        Points of each emulator, as far as there are runs; fewer are the first of more.
    """
    found = []
    good = (runs.table["status"] == "ok").to_numpy()
    for key, form in forms.items():
        plain = [runs.specs[i] for i in np.flatnonzero(runs.of(key) & good)]
        plain = [spec for spec in plain if not _on(spec, effects)]
        for number, switch in enumerate(form.switches):
            if switch.name not in effects:
                continue
            found += [
                replace(plain[i], effects={**plain[i].effects, switch.name: strength})
                for i, strength in zip(
                    _spread(len(plain), number, count), _strengths(switch, count), strict=False
                )
            ]
    return found


def _spread(total: int, number: int, count: int) -> list[int]:
    """Return so many different indices below a total, spread evenly, other ones for each number."""
    found: dict[int, None] = {}
    steps = itertools.count()
    while len(found) < min(count, total):
        found[int(total * ((next(steps) + 0.1 * number) * GOLDEN % 1.0))] = None
    return list(found)


def _on(spec: CaseSpec, effects: Collection[str]) -> bool:
    return any(spec.effects.get(name, 0.0) != 0.0 for name in effects)


def _strengths(switch: Switch, count: int) -> list[float]:
    """Return strengths of twins; the ends take turns, and so do a half and the whole reach."""
    reach = REACH * switch.step
    high, low = min(reach, switch.high), max(-reach, switch.low)
    ends = [end for end in (high, low) if end != 0.0]
    return [ends[k % len(ends)] * (0.5 if k // len(ends) % 2 else 1.0) for k in range(count)]


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
