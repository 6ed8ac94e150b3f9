"""How right forecasts are: the figures of a suite, per method."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, TypeAlias

import numpy as np
import pandas as pd
from scipy import stats

from calibrate.arrays import Array
from calibrate.challenge.cases import Case

__all__ = ["FIGURES", "WEAK", "Figure", "cause_table", "reliability_table", "score_table"]

Record: TypeAlias = dict[str, Any]
FLOOR: Final = 1e-4
"""Probability below which no forecast is scored."""
SMALL_SET: Final = 2
WEAK, STRONG, STRONGEST = 4.0, 8.0, 16.0
"""Non-centralities from which a cause counts as of 5.6, from which as of 11, and up to which."""
FOREIGN_VISIBLE: Final = 4.0
BINS: Final = 10
LEAST: Final = 0.01
"""Stated probability from which it counts for the reliability; below, all are right."""


@dataclass(frozen=True)
class Figure:
    """One number of the table.

    Attributes
    ----------
    name : str
    required : str
        What is asked for; empty if nothing is.
    compute : callable
        Cases to a number and to how many studies are behind it.
    """

    name: str
    required: str
    compute: Callable[[Sequence[Case]], tuple[float, int]]


def _share(found: Sequence[float]) -> tuple[float, int]:
    return (float(np.mean(found)) if len(found) else float("nan")), len(found)


def upper_bound(wrong: int, count: int, level: float = 0.95) -> float:
    """Return the one-sided upper bound of a rate (Clopper and Pearson)."""
    if wrong == count:
        return 1.0
    return float(stats.beta.ppf(level, wrong + 1, count - wrong))


def _blameless(cases: Sequence[Case]) -> list[Case]:
    return [one for one in cases if one.kind in ("nothing", "foreign")]


def _false_names(cases: Sequence[Case]) -> tuple[float, int]:
    wrong = [one.verdict == "named" for one in _blameless(cases)]
    return upper_bound(sum(wrong), len(wrong)) if wrong else float("nan"), len(wrong)


def _false_names_or_sets(cases: Sequence[Case]) -> tuple[float, int]:
    return _share([bool(one.names) for one in _blameless(cases)])


def _wrong_names(cases: Sequence[Case]) -> tuple[float, int]:
    causes = [one for one in cases if one.kind in ("single", "pair")]
    return _share([one.verdict == "named" and not set(one.names) & set(one.hidden)
                   for one in causes])  # fmt: skip


def _singles(cases: Sequence[Case], low: float, high: float) -> list[Case]:
    return [one for one in cases if one.kind == "single" and low <= one.size < high]


def _away(one: Case) -> float:
    return one.away


def _unlike(one: Case) -> float:
    return one.unlike


def _found_as_seen(
    far: Callable[[Case], float], low: float, high: float
) -> Callable[[Sequence[Case]], tuple[float, int]]:
    """Count by how far data or cause really are from the base model, not by what was drawn."""

    def compute(cases: Sequence[Case]) -> tuple[float, int]:
        seen = [one for one in cases if one.kind == "single" and low <= far(one) < high]
        return _share([_right(one) for one in seen])

    return compute


def _right(one: Case) -> bool:
    return one.hidden[0] in one.names and len(one.names) <= SMALL_SET


def _found(low: float, high: float) -> Callable[[Sequence[Case]], tuple[float, int]]:
    return lambda cases: _share([_right(one) for one in _singles(cases, low, high)])


def _alone(cases: Sequence[Case]) -> tuple[float, int]:
    return _share([one.names == one.hidden for one in _singles(cases, STRONG, STRONGEST)])


def _probability(cases: Sequence[Case]) -> tuple[float, int]:
    return _share([one.probability(one.hidden[0]) for one in _singles(cases, WEAK, np.inf)])


def _foreign(far: Callable[[Case], float]) -> Callable[[Sequence[Case]], tuple[float, int]]:
    """Count what is foreign where it is seen from far enough."""

    def compute(cases: Sequence[Case]) -> tuple[float, int]:
        seen = [one for one in cases if one.kind == "foreign" and far(one) >= FOREIGN_VISIBLE]
        return _share([one.verdict == "unknown" for one in seen])

    return compute


def _tested(cases: Sequence[Case]) -> tuple[float, int]:
    seen = [one for one in cases if one.kind == "foreign" and one.away >= FOREIGN_VISIBLE]
    return _share([one.tested for one in seen])


def _stated(cases: Sequence[Case]) -> tuple[Array, Array]:
    """Return stated probabilities of all answers, and whether they held."""
    stated, held = [], []
    for one in cases:
        if one.forecast is None:
            continue
        answers = {**one.forecast["inclusion"], "none": one.forecast["none"],
                   "unknown": one.forecast["unknown"]}  # fmt: skip
        truly = set(one.hidden) if one.kind in ("single", "pair") else set()
        truly |= {"none"} if one.kind == "nothing" else set()
        truly |= {"unknown"} if one.kind == "foreign" else set()
        for name, p in answers.items():
            if p >= LEAST:
                stated.append(float(p))
                held.append(name in truly)
    return np.array(stated), np.array(held, dtype=float)


def _reliability(cases: Sequence[Case]) -> tuple[float, int]:
    table = reliability_table(cases)
    if not len(table):
        return float("nan"), 0
    weights = table["answers"] / table["answers"].sum()
    return float(np.sum(weights * np.abs(table["stated"] - table["held"]))), len(cases)


def reliability_table(cases: Sequence[Case]) -> pd.DataFrame:
    """Return stated probabilities beside how often they held, by tenths."""
    stated, held = _stated(cases)
    bins = np.minimum((stated * BINS).astype(int), BINS - 1)
    rows = [
        {"answers": int(np.sum(bins == k)), "stated": float(stated[bins == k].mean()),
         "held": float(held[bins == k].mean())}
        for k in range(BINS)
        if np.any(bins == k)
    ]  # fmt: skip
    return pd.DataFrame(rows, columns=["answers", "stated", "held"])


def cause_table(cases: Sequence[Case]) -> pd.DataFrame:
    """Return how each cause fares where it is hidden alone, from non-centrality 5.6.

    Parameters
    ----------
    cases : sequence of Case

    Returns
    -------
    DataFrame
        Index cause, the best known first: studies, shares named alone, in a set of two at most and
        in any set, and the mean probability.
    """
    rows = []
    for cause in sorted({one.hidden[0] for one in _singles(cases, WEAK, np.inf)}):
        mine = [one for one in _singles(cases, WEAK, np.inf) if one.hidden[0] == cause]
        rows.append({
            "cause": cause,
            "studies": len(mine),
            "named": np.mean([one.names == [cause] for one in mine]),
            "in a set of two": np.mean([_right(one) for one in mine]),
            "in a set": np.mean([cause in one.names for one in mine]),
            "probability": np.mean([one.probability(cause) for one in mine]),
        })  # fmt: skip
    columns = ["cause", "studies", "named", "in a set of two", "in a set", "probability"]
    found = pd.DataFrame(rows, columns=columns).set_index("cause")
    return found.sort_values("probability", ascending=False, kind="stable")


def _log_score(cases: Sequence[Case]) -> tuple[float, int]:
    """Return the mean logarithm of the probability of what was true."""
    logs = []
    for one in cases:
        if one.kind == "pair":
            p = _pair_probability(one)
        elif one.kind == "single":
            p = one.probability(one.hidden[0])
        else:
            key = "none" if one.kind == "nothing" else "unknown"
            p = float(one.forecast[key]) if one.forecast else 0.0
        logs.append(np.log(max(p, FLOOR)))
    return (float(np.mean(logs)) if logs else float("nan")), len(logs)


def _pair_probability(one: Case) -> float:
    for a, b, p in one.forecast["pairs"] if one.forecast else ():
        if {a, b} == set(one.hidden):
            return float(p)
    return 0.0


def _coverage(cases: Sequence[Case]) -> tuple[float, int]:
    inside = []
    for one in cases:
        known = one.forecast["strengths"] if one.forecast else {}
        for hidden in one.truth["hidden"]:
            if hidden["name"] in known and hidden["strength"]:
                low, _, high = known[hidden["name"]]
                inside.append(bool(low <= hidden["strength"] <= high))
    return _share(inside)


def _pairs(cases: Sequence[Case]) -> tuple[float, int]:
    seen = [one for one in cases if one.kind == "pair" and one.size >= STRONG]
    return _share([set(one.names) == set(one.hidden) for one in seen])


def _one_of_pair(cases: Sequence[Case]) -> tuple[float, int]:
    seen = [one for one in cases if one.kind == "pair"]
    return _share([bool(set(one.names) & set(one.hidden)) for one in seen])


def _gains(cases: Sequence[Case]) -> tuple[float, int]:
    held = []
    for one in cases:
        if one.gained is not None and one.forecast is not None:
            claim = one.forecast["gain"]
            held.append(bool(claim["low"] <= one.gained <= claim["high"]))
    return _share(held)


FIGURES: Final = (
    Figure("false names, nulls and foreign, upper 95 % bound", "<= 0.03", _false_names),
    Figure("false names and sets, nulls and foreign, rate", "", _false_names_or_sets),
    Figure("wrong names where a cause is hidden, rate", "", _wrong_names),
    Figure("right, alone or in a set of two, at 2.8", "", _found(2.0, WEAK)),
    Figure("right, alone or in a set of two, at 5.6", ">= 0.80", _found(WEAK, STRONG)),
    Figure("right, alone or in a set of two, at 11", ">= 0.95", _found(STRONG, STRONGEST)),
    Figure("right, alone or in a set of two, above 16", "", _found(STRONGEST, np.inf)),
    Figure("the same, really 4 to 8 away", "", _found_as_seen(_away, WEAK, STRONG)),
    Figure("the same, really 8 to 16 away", "", _found_as_seen(_away, STRONG, STRONGEST)),
    Figure("the same, really more than 16 away", "", _found_as_seen(_away, STRONGEST, np.inf)),
    Figure("the same, less than 4 from some parameters", "", _found_as_seen(_unlike, 0.0, WEAK)),
    Figure("the same, 4 to 8 from any parameters", "", _found_as_seen(_unlike, WEAK, STRONG)),
    Figure("the same, 8 to 16 from any parameters", "", _found_as_seen(_unlike, STRONG, STRONGEST)),
    Figure(
        "the same, more than 16 from any parameters", "", _found_as_seen(_unlike, STRONGEST, np.inf)
    ),
    Figure("named alone at 11", ">= 0.70 (known)", _alone),
    Figure("mean probability of the cause at 5.6 and above", ">= 0.66", _probability),
    Figure("foreign at 4 sigma called unknown", ">= 0.70", _foreign(_away)),
    Figure("the same, by a 5 % test of what causes leave", "", _tested),
    Figure("foreign 4 sigma from every cause too", "", _foreign(lambda one: one.beyond)),
    Figure("error of stated probabilities", "<= 0.05", _reliability),
    Figure("mean log score", "", _log_score),
    Figure("strengths in their 90 % intervals", "0.80 to 0.97", _coverage),
    Figure("pairs at 11: both, no third", ">= 0.50", _pairs),
    Figure("pairs: at least one", "", _one_of_pair),
    Figure("true gain in the claimed interval", ">= 0.90", _gains),
)


def score_table(methods: Mapping[str, Sequence[Case]]) -> pd.DataFrame:
    """Return the figures, a column per method, with the number of studies of the first.

    Parameters
    ----------
    methods : mapping
        Method to the cases that count for it.
    """
    rows = []
    for figure in FIGURES:
        row: Record = {"figure": figure.name, "required": figure.required}
        for name, cases in methods.items():
            value, count = figure.compute(cases)
            row.setdefault("studies", count)
            row[name] = value
        rows.append(row)
    return pd.DataFrame(rows).set_index("figure")
