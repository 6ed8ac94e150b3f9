"""What to do next, in one sentence, and as plain data: measurements ranked by what they tell."""

from __future__ import annotations

from typing import Any, Final

from calibrate.causes.diagnosis import Diagnosis
from calibrate.causes.judging.probabilities import UNKNOWN
from calibrate.causes.next_measurement import Offer
from calibrate.causes.told.numbers import short, with_unit

__all__ = ["SHOWN", "is_settled", "next_record", "next_step"]

ENOUGH: Final = 0.9
"""Probability of "none" from which nothing more has to be measured for the cause."""
SHOWN: Final = 5
"""Measurements that are told."""


def is_settled(found: Diagnosis) -> bool:
    """Whether nothing is suspected."""
    return found.verdict.kind == "none" and found.verdict.answers.none > ENOUGH


def next_record(found: Diagnosis) -> dict[str, Any]:
    """Return the measurements that tell most per hour as plain data.

    Parameters
    ----------
    found : Diagnosis

    Returns
    -------
    dict
        ``open_nats``, how open it is which answer holds; ``offers``, each with name, words, unit,
        se, hours, nats, nats_per_hour and outcomes (value, probability of the leading answers).
    """
    offers = () if is_settled(found) else found.prospect.offers[:SHOWN]
    return {
        "open_nats": found.prospect.entropy,
        "offers": [
            {
                "name": one.measurement.name,
                "words": one.measurement.words,
                "unit": one.measurement.unit,
                "se": one.measurement.se,
                "hours": one.measurement.hours,
                "nats": one.information,
                "nats_per_hour": one.per_hour,
                "outcomes": [
                    {"value": result.value, "probability": dict(result.probability)}
                    for result in one.outcomes
                ],
            }
            for one in offers
        ],
    }


def next_step(found: Diagnosis) -> str:
    """Return what to measure next, and what its results would mean."""
    if is_settled(found):
        return (
            "Next: nothing more has to be measured for the cause; that nothing is missing has "
            f"probability {found.verdict.answers.none:.2f}."
        )
    said = {"unknown": _apparatus, "named": _confirming}.get(found.verdict.kind, _nothing)(found)
    offers = found.prospect.offers
    if not offers:
        said.append(
            "None of the measurements that the program knows would tell more about which cause it "
            "is."
        )
        return f"Next: {' '.join(said)}"
    best = offers[0]
    word = f"{best.measurement.name}={short(best.outcomes[0].value)}+-{best.measurement.se:g}"
    said.append(
        f"{_words(best, found.prospect.entropy)} What a result would mean: bulkcal diagnose STUDY "
        f'--with "{word}"; measured, it goes into the study under [known].'
    )
    return f"Next: {' '.join(said)}"


def _words(one: Offer, entropy: float) -> str:
    """Say what is measured, what it tells, and what each result would mean."""
    what = one.measurement
    error = with_unit(f"{what.se:g}", what.unit)
    results = "; ".join(
        f"if it gives {with_unit(short(result.value), what.unit)}: "
        + ", ".join(f"{name} {p:.2f}" for name, p in result.probability.items())
        for result in one.outcomes
    )
    return (
        f"{what.words} ({what.name}, good to {error}, {what.hours:g} h) tells most per hour, "
        f"{one.information:.2f} of the {entropy:.2f} nats that are open: {results}."
    )


def _nothing(_found: Diagnosis) -> list[str]:
    return []


def _apparatus(found: Diagnosis) -> list[str]:
    where, share = next(iter(found.verdict.answers.where.items()))
    place = where.removeprefix(UNKNOWN).split(" ", 2)[-1]
    return [
        f"measure the apparatus behind {place} again and compare it with the study's values: if no "
        f"candidate is the cause, it acts there with a share of {share:.2f}."
    ]


def _confirming(found: Diagnosis) -> list[str]:
    """Say what would confirm a name, if it does not rest on that already."""
    members = found.board.members(found.verdict.names)
    open_ = [one for one in members if not found.board.measured(one)]
    hints = dict.fromkeys(one.settled_by or f"measure {one.name}" for one in open_)
    return [f"to confirm the name: {'; '.join(hints)}."] if hints else []
