"""From finished runs to emulators that know causes, by twins and by readings that cost no run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.causes.studies.twins import FEWEST, spread_over, twin_strengths
from calibrate.emulator.emulator import TrainedEmulator
from calibrate.emulator.signature import Twins
from calibrate.emulator.types import Inputs
from calibrate.emulator.with_effects import Change, WithEffects, learn_change
from calibrate.questions.core.emulate import Emulators
from calibrate.questions.core.forms import Form, FormKey, Switch
from calibrate.questions.core.outputs import outputs_of
from calibrate.questions.core.runs import Runs
from calibrate.scales import forward
from liggghts_io import CaseSpec, experiment_of
from liggghts_io.case.spec import setup_of
from liggghts_io.effects import Effect
from liggghts_io.errors import CaseError
from liggghts_io.experiments.numbers import Curve
from liggghts_io.experiments.setup import Observed

__all__ = ["learn_effects"]

READINGS: Final = 32
"""Runs whose readings are changed to see what an instrument does."""


def learn_effects(
    emulators: Emulators,
    wider: Mapping[FormKey, Form],
    runs: Runs,
    effects: Mapping[str, Effect],
) -> dict[FormKey, WithEffects]:
    """Return every emulator with what effects add to it.

    Parameters
    ----------
    emulators : Emulators
        Of the base model.
    wider : mapping
        Forms of the study with all effects free; the base model's switches stand first.
    runs : Runs
        Of the base model and with single effects on.
    effects : mapping
        By name.
    """
    found = {}
    for key, form in wider.items():
        trained = emulators.trained[key]
        table = _Table(form, runs, key)
        changes: dict[int, Change] = {}
        for column, switch in enumerate(form.switches):
            if column < trained.emulator.effects:
                continue
            effect = effects[switch.name]
            twins = (
                table.twins(switch, trained.emulator)
                if effect.needs_runs
                else table.read(switch, effect)
            )
            if len(twins) >= FEWEST:
                changes[column] = learn_change(trained.emulator, twins)
        found[key] = WithEffects(trained.emulator, changes, len(form.switches))
    return found


class _Table:
    """Runs of one form: where each lies, its outputs, and who is whose twin."""

    def __init__(self, form: Form, runs: Runs, key: FormKey) -> None:
        self.form = form
        rows = np.flatnonzero(runs.of(key))
        self.specs = [runs.specs[i] for i in rows]
        self.rows = runs.table.iloc[rows].reset_index(drop=True)
        there = [form.place_in(spec) for spec in self.specs]
        self.u = np.array([u for u, _ in there])
        self.strengths = np.array([strengths for _, strengths in there])
        self.y = outputs_of(form, self.rows)
        told = [name for one in form.outputs for name in one.table_columns]
        self.ended = self.rows.reindex(columns=told).notna().all(axis=1).to_numpy()
        self.names = {one.name for one in form.switches}
        self.plain = {
            _key(spec): i
            for i, spec in enumerate(self.specs)
            if not any(spec.effects.get(name, 0.0) for name in self.names)
        }

    def twins(self, switch: Switch, base: TrainedEmulator) -> Twins:
        """Return the runs with one effect on beside their twins without it.

        Where nobody ran a twin, what is expected without the effect has to do.
        """
        pairs, strengths = [], []
        for i, spec in enumerate(self.specs):
            strength = spec.effects.get(switch.name, 0.0)
            rest = {name: x for name, x in spec.effects.items() if name != switch.name and x}
            if not strength or any(name in self.names for name in rest):
                continue
            pairs.append((i, self.plain.get(_key(spec, rest), i)))
            strengths.append(strength / switch.step)
        if not pairs:
            none = np.zeros((0, self.u.shape[1] if len(self.u) else 0))
            nothing = np.zeros((0, self.form.width))
            return Twins(none, np.zeros(0), nothing, nothing)
        on, off = np.array(pairs).T
        known = self.strengths[off][:, : base.effects]
        expected = base.predict(Inputs.at(self.u[off], known)).mean
        both = np.isfinite(self.y[on]) & np.isfinite(self.y[off])
        change, luck = (np.where(both, self.y[k] - expected, np.nan) for k in (on, off))
        luck[on == off] *= 0.0  # of a run without a twin; nan stays
        return _good(Twins(self.u[off], np.array(strengths), change, luck))

    def read(self, switch: Switch, effect: Effect) -> Twins:
        """Return what an instrument changes of finished runs."""
        plain = sorted(self.plain.values())
        chosen = [plain[k] for k in spread_over(len(plain), 0, READINGS)]
        strengths = twin_strengths(effect, switch, len(chosen))
        u, x, change = [], [], []
        for i, strength in zip(chosen, strengths, strict=True):
            if not self.ended[i]:
                continue
            try:
                y = self._read(self.specs[i], i, effect, strength)
            except CaseError:
                continue
            u.append(self.u[i])
            x.append(strength / switch.step)
            change.append(y - self.y[i])
        width = self.form.width
        return _good(
            Twins(
                np.array(u).reshape(len(u), -1),
                np.array(x),
                np.array(change).reshape(len(u), width),
                np.zeros((len(u), width)),
            )
        )

    def _read(self, spec: CaseSpec, row: int, effect: Effect, strength: float) -> Array:
        """Return the outputs of a run as an instrument with an error shows them."""
        if effect.read is None:
            return np.asarray(self.y[row])
        curves = {one.name: one for one in experiment_of(spec).curves}
        values, tables = {}, {}
        for one in self.form.outputs:
            cells = self.rows.loc[row, one.table_columns].to_numpy(float)
            if one.levels:
                curve = curves[one.name]
                tables[curve.file] = {curve.x_column: np.array(one.levels), curve.y_column: cells}
            else:
                values[one.name] = float(cells[0])
        seen = effect.read(Observed(values, tables), strength, setup_of(spec))
        y = np.empty(self.form.width)
        for one in self.form.outputs:
            if one.levels:
                read = _at_levels(seen, curves[one.name], one.levels)
            else:
                read = np.array([seen.values[one.name]])
            y[one.columns] = forward(one.scale, read)
        return y


def _at_levels(seen: Observed, curve: Curve, levels: Sequence[float]) -> Array:
    """Return a curve at levels, its last piece drawn on where it was stretched beyond them."""
    table = seen.tables[curve.file]
    x, y = np.asarray(table[curve.x_column]), np.asarray(table[curve.y_column])
    found = np.interp(levels, x, y)
    ends = ((levels < x[0], 0, 1), (levels > x[-1], -1, -2))
    for beyond, end, inner in ends:
        slope = (y[end] - y[inner]) / (x[end] - x[inner])
        found = np.where(beyond, y[end] + slope * (np.asarray(levels) - x[end]), found)
    return np.asarray(found)


def _good(twins: Twins) -> Twins:
    if not len(twins):
        return twins
    return twins.rows(np.asarray(np.isfinite(twins.change).any(axis=1)))


def _key(spec: CaseSpec, effects: Mapping[str, float] | None = None) -> tuple[object, ...]:
    """Return what two runs have in common that differ by effects alone."""
    own = spec.effects if effects is None else effects
    return (
        spec.particle.name,
        spec.seed,
        tuple(sorted((k, round(v, 9)) for k, v in spec.parameters.items())),
        tuple(sorted(spec.apparatus.items())),
        tuple(sorted((k, v) for k, v in own.items() if v)),
    )
