"""What moves what in a study: tables, figures, sentences."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Final

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from calibrate.errors import CalibrationError, unknown_name
from calibrate.questions.sensitivity.baseline import ELASTIC
from calibrate.questions.sensitivity.figures import indices_figure, responses_figure
from calibrate.questions.sensitivity.responses import Response
from calibrate.questions.sensitivity.shares import Explained, Share
from calibrate.study.data import StudyData

__all__ = ["SensitivityResult", "sentences_of"]

KEYS: Final = ("place", "output", "parameter")
POOR: Final = 0.1
"""Share of the emulator's error in the variance from which a reader is told."""


@dataclass(frozen=True, repr=False)
class SensitivityResult:
    """What moves what.

    Attributes
    ----------
    data : StudyData
    baseline : mapping
        Value of every parameter, by its name in the study and, where there are several, instance.
    levels, seeds : int
        Values over each range, and runs of each.
    responses : tuple of Response
        One parameter at a time.
    shares : tuple of Share
        Sobol indices over the ranges.
    explained : tuple of Explained
        How well each output is known.
    runs, failed : int
        Runs behind all of it.
    sentences : tuple of str
        What a reader should know.
    """

    data: StudyData
    baseline: Mapping[str, float]
    levels: int
    seeds: int
    responses: tuple[Response, ...]
    shares: tuple[Share, ...]
    explained: tuple[Explained, ...]
    runs: int
    failed: int
    sentences: tuple[str, ...]

    def __repr__(self) -> str:
        """Return one line; the table has the rest."""
        return (
            f"SensitivityResult({self.data.study.title!r}: {self.runs} runs; see .table(), "
            ".figure(), .indices_figure(), .sentences)"
        )

    @property
    def places(self) -> tuple[str, ...]:
        """Places in words."""
        words = (*(one.where for one in self.responses), *(one.where for one in self.shares))
        return tuple(dict.fromkeys(words))

    def table(self) -> pd.DataFrame:
        """Return a row per place, output and parameter.

        Returns
        -------
        DataFrame
            One at a time: ``low`` and ``high`` of the parameter, ``at_low``, ``at_high`` and
            ``change`` of the output with its ``unit``, ``noise`` of one run, ``p`` that the seeds
            alone do this, ``direction``. Over the ranges: ``first`` and ``total`` Sobol index with
            90 % intervals, ``made`` by the emulator's error, ``seen``. Empty where one of the two
            was not asked for: the elastic constants have no index, and only what is measured has.
        """
        rows: dict[tuple[str, ...], dict[str, Any]] = {}
        for part in (*map(_single, self.responses), *map(_whole, self.shares)):
            rows.setdefault(tuple(part[key] for key in KEYS), {}).update(part)
        return pd.DataFrame(list(rows.values()))

    def figure(self, place: str = "") -> Figure:
        """Return the curves, one parameter at a time: a row per output, a column per parameter.

        Parameters
        ----------
        place : str
            One of `places`; all of them where it is left out.

        Raises
        ------
        CalibrationError
            For an unknown place, and where nothing was run one at a time.
        """
        shown = self._at(place, self.responses)
        if not shown:
            msg = "figure: nothing was run one parameter at a time; see .indices_figure()"
            raise CalibrationError(msg)
        return responses_figure(shown)

    def indices_figure(self, place: str = "") -> Figure:
        """Return the Sobol indices as bars; `place` and errors as `figure`."""
        shown = self._at(place, self.shares)
        if not shown:
            msg = "indices_figure: there are no Sobol indices; see .sentences"
            raise CalibrationError(msg)
        return indices_figure(shown)

    def _at(self, place: str, rows: Sequence[Any]) -> list[Any]:
        if place and place not in self.places:
            msg = f"place: {unknown_name(place, self.places)}"
            raise CalibrationError(msg)
        return [one for one in rows if place in ("", one.where)]

    def record(self) -> dict[str, Any]:
        """Return everything as plain data."""
        return {
            "study": self.data.study.name,
            "study_file": str(self.data.path),
            "study_sha256": self.data.sha256,
            "title": self.data.study.title,
            "baseline": dict(self.baseline),
            "levels": self.levels,
            "seeds": self.seeds,
            "one_at_a_time": [
                {**_single(one), "values": one.x.tolist(), "runs": one.y.tolist()}
                for one in self.responses
            ],
            "sobol": [_whole(one) for one in self.shares],
            "emulators": [
                {KEYS[0]: one.where, KEYS[1]: one.name}
                | {k: v for k, v in asdict(one).items() if k not in ("where", "name")}
                for one in self.explained
            ],
            "sentences": list(self.sentences),
            "runs": self.runs,
            "failed_runs": self.failed,
        }


def _single(one: Response) -> dict[str, Any]:
    good = one.means[np.isfinite(one.means)]
    ends = (float(good[0]), float(good[-1])) if len(good) else (np.nan, np.nan)
    return {
        "place": one.where,
        "output": one.name,
        "parameter": one.parameter,
        "unit": one.unit,
        "low": float(one.x[0]),
        "high": float(one.x[-1]),
        "at_low": ends[0],
        "at_high": ends[1],
        "change": one.change,
        "span": one.span,
        "noise": one.noise,
        "p": one.p,
        "direction": one.direction,
    }


def _whole(one: Share) -> dict[str, Any]:
    return {
        "place": one.where,
        "output": one.name,
        "parameter": one.parameter,
        "first": one.first,
        "first_low": one.first_span[0],
        "first_high": one.first_span[1],
        "total": one.total,
        "total_low": one.total_span[0],
        "total_high": one.total_span[1],
        "made": one.made,
        "seen": one.seen,
    }


def sentences_of(
    responses: Sequence[Response], shares: Sequence[Share], explained: Sequence[Explained]
) -> list[str]:
    """Say what does nothing, what the elastic constants do, and which indices mean little."""
    return [*_elastic(responses), *_nothing(responses), *_unseen(shares), *_poor(explained)]


def _elastic(responses: Sequence[Response]) -> list[str]:
    """Say whether the grains may be simulated softer than they are."""
    said = []
    for name in dict.fromkeys(one.parameter for one in responses if one.parameter in ELASTIC):
        mine = [one for one in responses if one.parameter == name]
        ends = f"{name} from {mine[0].x[0]:g} to {mine[0].x[-1]:g}"
        moved = [one for one in mine if one.direction != "not seen"]
        if not moved:
            said.append(f"{ends}: no output moves by more than the luck of the seeds")
        for one in moved:
            of = max(abs(float(np.nanmean(one.y))), np.finfo(float).tiny)
            share = "" if one.unit == "score" else f" ({100.0 * one.span / of:.2g} % of its mean)"
            said.append(
                f"{ends} moves {one.name} of {one.where} by up to {one.span:.3g} {one.unit}{share}"
            )
    return said


def _nothing(responses: Sequence[Response]) -> list[str]:
    """Name the parameters that move nothing at all."""
    said = []
    for name in dict.fromkeys(r.parameter for r in responses if r.parameter not in ELASTIC):
        if all(one.direction == "not seen" for one in responses if one.parameter == name):
            said.append(f"{name}: moves no output by more than the luck of the seeds")
    return said


def _unseen(shares: Sequence[Share]) -> list[str]:
    """Count the indices that the emulators' error could make."""
    weak = [one for one in shares if not one.seen]
    if not weak:
        return []
    return [
        f"{len(weak)} of {len(shares)} total Sobol indices are no larger than what the error of "
        "the emulator alone makes (marked *); more runs would show whether they are zero"
    ]


def _poor(explained: Sequence[Explained]) -> list[str]:
    """Name the outputs of which little is known."""
    return [
        f"{one.name} of {one.where}: the emulator's error is {100.0 * one.error_share:.0f} % of "
        f"the variance over the ranges ({one.runs} runs), so its indices are rough"
        for one in explained
        if one.error_share > POOR
    ]
