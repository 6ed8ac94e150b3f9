"""Effect twins: runs that differ from a finished one by a single effect, so that luck cancels.

A few of each effect first; more only of those that the data could show at all.
"""

from __future__ import annotations

import itertools
from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from calibrate.questions.core.forms import Form, FormKey, Switch
from calibrate.questions.core.runs import Runs
from liggghts_io import CaseSpec
from liggghts_io.effects import Effect

__all__ = [
    "FEWEST", "GOLDEN", "REACH", "SCREENED", "TWINS", "spread_over", "twin_cases", "twin_strengths",
]  # fmt: skip

REACH: Final = 5.0
"""Strength of effect twins, in ordinary strengths; little less than what is considered."""
PARTS: Final = {2: (1.0, 0.5), 1: (1.0, 0.5, 0.25)}
"""Parts of the reach that take turns, by the number of signs that are possible."""
SCREENED: Final = 4
"""Points of each emulator at which each effect is switched on, to see whether it can be seen."""
FEWEST: Final = 3
"""Twins below which an effect is not learnt."""
TWINS: Final = 12
"""Points for an effect that can be seen, where nobody asks for another number."""
GOLDEN: Final = 0.6180339887498949
"""Fraction whose multiples are spread most evenly, however many there are."""


def twin_cases(
    forms: Mapping[FormKey, Form],
    runs: Runs,
    effects: Mapping[str, Effect],
    wanted: Collection[str],
    count: int,
) -> list[CaseSpec]:
    """Return cases that differ from finished runs by one effect only.

    Parameters
    ----------
    forms : mapping
        Of the study with all effects, see `calibrate.causes.studies.from_study.with_effects`.
    runs : Runs
        Of the base model. Points and seeds are theirs.
    effects : mapping
        By name.
    wanted : collection of str
        Which to switch on; those of instruments need no run.
    count : int
        Points of each emulator, as far as there are runs; fewer are the first of more.
    """
    found = []
    good = (runs.table["status"] == "ok").to_numpy()
    for key, form in forms.items():
        names = {switch.name for switch in form.switches if switch.name in effects}
        plain = [runs.specs[i] for i in np.flatnonzero(runs.of(key) & good)]
        plain = [spec for spec in plain if not any(spec.effects.get(name) for name in names)]
        for number, switch in enumerate(form.switches):
            if switch.name not in wanted or not effects[switch.name].needs_runs:
                continue
            at = spread_over(len(plain), number, count)
            strengths = twin_strengths(effects[switch.name], switch, len(at))
            found += [
                replace(plain[i], effects={**plain[i].effects, switch.name: strength})
                for i, strength in zip(at, strengths, strict=True)
            ]
    return found


def spread_over(total: int, number: int, count: int) -> list[int]:
    """Return so many different indices below a total, spread evenly, other ones for each number."""
    found: dict[int, None] = {}
    steps = itertools.count()
    while len(found) < min(count, total):
        found[int(total * ((next(steps) + 0.1 * number) * GOLDEN % 1.0))] = None
    return list(found)


def twin_strengths(effect: Effect, switch: Switch, count: int) -> list[float]:
    """Return strengths of twins; the ends take turns, and so do parts of the reach."""
    if effect.switch:
        return [1.0] * count
    reach = REACH * switch.step
    high, low = min(reach, switch.high), max(-reach, switch.low)
    ends = [end for end in (high, low) if end != 0.0]
    parts = PARTS[len(ends)]
    return [ends[k % len(ends)] * parts[k // len(ends) % len(parts)] for k in range(count)]
