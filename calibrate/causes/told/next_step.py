"""What to do next, in one sentence, and as plain data: measurements ranked by what they tell."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from calibrate.causes.diagnosis import Diagnosis
from calibrate.causes.judging.probabilities import UNKNOWN
from calibrate.causes.offers import Feasible, Offer, Outcome, Trial
from calibrate.causes.told.numbers import result_words, short, with_unit
from calibrate.causes.weighing.unknown import EVERYWHERE

__all__ = ["SHOWN", "is_settled", "next_record", "next_step"]

ENOUGH: Final = 0.9
"""Probability of "none" from which nothing more has to be measured for the cause."""
SHOWN: Final = 5
"""Measurements that are told; experiments that were tried are all told."""


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
        ``open_nats``, how open it is which answer holds; ``offers``, each with name, words, reads
        (name, unit and se of each number), hours, nats, nats_per_hour, outcomes (values of these
        numbers, probability of the leading answers) and next, the command to type.
    """
    offers = () if is_settled(found) else _shown(found.prospect.offers)
    return {
        "open_nats": found.prospect.entropy,
        "offers": [
            {
                "name": one.measurement.name,
                "words": one.measurement.words,
                "reads": [read._asdict() for read in one.measurement.reads],
                "hours": one.measurement.hours,
                "nats": one.information,
                "nats_per_hour": one.per_hour,
                "outcomes": [
                    {"values": list(result.values), "probability": dict(result.probability)}
                    for result in one.outcomes
                ],
                "next": _command(one),
            }
            for one in offers
        ],
    }


def _shown(offers: Sequence[Offer]) -> tuple[Offer, ...]:
    """Return those that tell most per hour, and every one that runs were spent on."""
    tried = [one for one in offers[SHOWN:] if isinstance(one.measurement, Trial)]
    return (*offers[:SHOWN], *tried)


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
    said += [_words(best, found.prospect.entropy), _after(best)]
    return f"Next: {' '.join(said)}"


def _command(one: Offer) -> str:
    """Return what to type next."""
    what = one.measurement
    if isinstance(what, Trial):
        return what.command
    word = f"{what.name}={short(one.outcomes[0].values[0])}+-{what.se:g}"
    return f'bulkcal diagnose STUDY --with "{word}"'


def _after(one: Offer) -> str:
    """Say what to type, and where the result goes."""
    command = _command(one)
    if isinstance(one.measurement, Feasible):
        return (
            f"What a result would mean: {command}; measured, it goes into the study under [known]."
        )
    if command:
        return (
            f"What it needs: {command}; measured, its numbers go into the study as targets, and "
            "the diagnosis is made again."
        )
    return (
        "A study holds one setting of each experiment, so hold what you measure against these "
        "results."
    )


def _words(one: Offer, entropy: float) -> str:
    """Say what is measured, what it tells, and what each result would mean."""
    what = one.measurement
    results = "; ".join(
        f"if it gives {_result(one, result)}: "
        + ", ".join(f"{name} {p:.2f}" for name, p in result.probability.items())
        for result in one.outcomes
    )
    return (
        f"{what.words} ({what.name}, good to {_errors(one)}, {what.hours:g} h) tells most per "
        f"hour, {one.information:.2f} of the {entropy:.2f} nats that are open: {results}."
    )


def _result(one: Offer, result: Outcome) -> str:
    reads = one.measurement.reads
    return result_words(result.values, [r.name for r in reads], [r.unit for r in reads])


def _errors(one: Offer) -> str:
    return ", ".join(with_unit(f"{read.se:g}", read.unit) for read in one.measurement.reads)


def _nothing(_found: Diagnosis) -> list[str]:
    return []


def _apparatus(found: Diagnosis) -> list[str]:
    where, share = next(iter(found.verdict.answers.where.items()))
    if where == EVERYWHERE:
        return [
            "measure what the experiments share, such as grains, walls and the flow of the "
            "funnels, again and compare it with the study's values: if no candidate is the cause, "
            f"it acts in more than one of them with a share of {share:.2f}."
        ]
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
