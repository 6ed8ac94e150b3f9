"""What a parameter does to a number by itself, and whether that is more than luck."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final, Literal, TypeAlias

import numpy as np
from scipy import stats

from calibrate.arrays import Array
from calibrate.emulator.components import Components, components_of
from calibrate.questions.core.forms import Emulated, Form, FormKey
from calibrate.questions.core.from_study import form_key, place_of
from calibrate.questions.core.runs import Runs
from calibrate.questions.sensitivity.steps import Series
from calibrate.scales import Scale, forward, scale_of
from calibrate.study.data import StudyData
from calibrate.study.places import Place

__all__ = ["Bases", "Response", "component_name", "kept_components", "responses_of"]

Direction: TypeAlias = Literal["rises", "falls", "both ways", "not seen"]
Bases: TypeAlias = Mapping[tuple[FormKey, str], Components]
"""Components of a curve by the form and the name of the curve."""

CHANCE: Final = 0.05
"""Probability that among all parameters of a number one is called seen that does nothing."""
ONE_WAY: Final = 0.8
"""Part of the whole span that lies between the ends of a range where a number rises or falls."""
LEAST_SHARE: Final = 0.05
"""Of a curve's variance that a component must have to be looked at."""
ROUNDING: Final = 1e-20
"""Sums of squares below it are rounding, in units of the values."""


@dataclass(frozen=True)
class Response:
    """A number at the values of one parameter, all others at the baseline.

    Attributes
    ----------
    where : str
        Place in words.
    name, unit : str
        Observable, or component of a curve.
    parameter : str
    instance : str
    baseline : float
    logarithmic : bool
        Whether the range is searched on a logarithmic scale.
    x : (V,) float64
        Values of the parameter.
    y : (V, S) float64
        A seed in each column, nan where a run failed.
    measured : (float, float)
        What was measured there and its standard error; nan where it was not.
    p : float
        Probability of such differences between values by the luck of the seeds alone, as the
        smallest of all parameters of this number; nan where nothing ever changes.
    """

    where: str
    name: str
    unit: str
    parameter: str
    instance: str
    baseline: float
    logarithmic: bool
    x: Array
    y: Array
    measured: tuple[float, float]
    p: float

    @property
    def means(self) -> Array:
        """Mean over the seeds, (V,); nan where all runs failed."""
        good = np.isfinite(self.y)
        total = np.where(good, self.y, 0.0).sum(axis=1)
        count = good.sum(axis=1)
        means = np.divide(total, count, out=np.full(len(count), np.nan), where=count > 0)
        return np.asarray(means)

    @property
    def noise(self) -> float:
        """Standard deviation of one run about the mean of its value, all values together."""
        within, dof = _within(self.y)
        return math.sqrt(within / dof) if dof else math.nan

    @property
    def change(self) -> float:
        """Mean at the highest value minus mean at the lowest."""
        good = self.means[np.isfinite(self.means)]
        return float(good[-1] - good[0]) if len(good) > 1 else math.nan

    @property
    def span(self) -> float:
        """Highest mean minus lowest."""
        good = self.means[np.isfinite(self.means)]
        return float(good.max() - good.min()) if len(good) else math.nan

    @property
    def direction(self) -> Direction:
        """What the number does as the parameter grows."""
        if not self.p < CHANCE:
            return "not seen"
        if abs(self.change) < ONE_WAY * self.span:
            return "both ways"
        return "rises" if self.change > 0.0 else "falls"


@dataclass(frozen=True)
class _Number:
    """An observable, or a component of a curve, of all runs."""

    name: str
    unit: str
    scale: Scale
    column: Array
    measured: tuple[float, float] = (math.nan, math.nan)


def responses_of(
    data: StudyData,
    series: Sequence[Series],
    runs: Runs,
    forms: Mapping[FormKey, Form],
    bases: Bases,
) -> list[Response]:
    """Return what every parameter does to every observable and measured curve.

    Parameters
    ----------
    data : StudyData
    series : sequence of Series
    runs : Runs
        All cases of the series, with the curves of the forms.
    forms : mapping
        Form by key.
    bases : mapping
        Components in which curves are looked at; those that are not there are made of these runs.
    """
    row_of = {repr(spec): row for row, spec in enumerate(runs.specs)}
    found: list[Response] = []
    for place in dict.fromkeys(one.place for one in series):
        here = [one for one in series if one.place == place]
        rows = [np.array([[row_of[repr(spec)] for spec in row] for row in s.specs]) for s in here]
        every = np.unique(np.concatenate([r.ravel() for r in rows]))
        form = forms[form_key(data.study, place)]
        for number in (*_numbers(data, place, runs), *_curves(runs, every, form, bases)):
            found += [
                _response(one, number, number.column[r], len(here))
                for one, r in zip(here, rows, strict=True)
            ]
    return found


def _response(one: Series, number: _Number, y: Array, among: int) -> Response:
    chance = _chance(forward(number.scale, y))
    return Response(
        one.where, number.name, number.unit, one.varied.name, one.varied.instance,
        one.varied.baseline, one.varied.spacing == "log", np.array(one.values), y, number.measured,
        float(np.minimum(among * chance, 1.0)),
    )  # fmt: skip


def _numbers(data: StudyData, place: Place, runs: Runs) -> list[_Number]:
    """Return all observables of an experiment."""
    study = data.study
    known = {t.observable: data.scalars[t.name] for t in study.numbers if place_of(t) == place}
    scales = {t.observable: t.model_scale for t in study.numbers if place_of(t) == place}
    good = (runs.table["status"] == "ok").to_numpy()
    found = []
    for one in study.experiments[place.experiment].observables:
        column = runs.table.get(one.name)
        if column is None:
            continue
        values = np.where(good, column.to_numpy(float), np.nan)
        scale = scales.get(one.name, scale_of(one.unit))
        number = _Number(one.name, one.unit, scale, values)
        if one.name in known:
            measured = known[one.name].value, known[one.name].se
            number = replace(number, measured=measured)
        found.append(number)
    return found


def _curves(runs: Runs, rows: Array, form: Form, bases: Bases) -> list[_Number]:
    """Return the scores of the components of measured curves at these runs."""
    found = []
    for one in form.outputs:
        if not one.levels:
            continue
        names = [name for name in one.table_columns if name in runs.table]
        y = np.full((len(runs), len(one.levels)), np.nan)
        if len(names) == len(one.levels):
            y[rows] = forward(one.scale, runs.table[names].to_numpy(float)[rows])
        good = np.isfinite(y).all(axis=1)
        if good.sum() < len(form.axes) + 2:
            continue
        components = bases.get((form.key, one.name)) or components_of(y[good])
        for k in kept_components(components, y[good]):
            scores = np.full(len(runs), np.nan)
            scores[good] = components.scores(y[good])[:, k]
            scores *= np.sign(components.basis[:, k].sum()) or 1.0
            found.append(_Number(component_name(one, k), "score", "linear", scores))
    return found


def kept_components(components: Components, y: Array) -> list[int]:
    """Return the components that matter among some curves.

    Parameters
    ----------
    components : Components
    y : (n, L) float64
        Curves on their model scale.
    """
    variances = components.scores(y).var(axis=0)
    total = variances.sum()
    return [k for k, v in enumerate(variances) if total > 0.0 and v > LEAST_SHARE * total]


def component_name(curve: Emulated, number: int) -> str:
    """Return how a component of a curve is called; the first is number 0."""
    return f"{curve.name}: component {number + 1}"


def _within(y: Array) -> tuple[float, int]:
    """Return the sum of squares of (V, S) values about their rows' means, and its degrees."""
    rows = [row[np.isfinite(row)] for row in y]
    squares = sum(float(np.sum((row - row.mean()) ** 2)) for row in rows if len(row))
    return squares, sum(max(len(row) - 1, 0) for row in rows)


def _chance(y: Array) -> float:
    """Return the probability of such differences between rows by luck (one-way F test)."""
    rows = [row[np.isfinite(row)] for row in y]
    rows = [row for row in rows if len(row)]
    within, dof = _within(y)
    if len(rows) < 2 or dof == 0:
        return math.nan
    middle = np.concatenate(rows).mean()
    between = sum(len(row) * float(row.mean() - middle) ** 2 for row in rows)
    tiny = ROUNDING * (1.0 + abs(middle)) ** 2
    if between <= tiny:
        return math.nan
    if within <= tiny:
        return 0.0
    ratio = between / (len(rows) - 1) / (within / dof)
    return float(stats.f.sf(ratio, len(rows) - 1, dof))
