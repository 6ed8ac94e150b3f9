"""Sentences for a reader: what is wrong, what the data can tell, what to measure next last."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

from calibrate.causes.diagnosis import Diagnosis
from calibrate.causes.gain import Gain
from calibrate.causes.judging.probabilities import NONE, UNKNOWN, inclusion_of
from calibrate.causes.told.next_step import next_step
from calibrate.causes.told.numbers import short, with_unit

__all__ = ["KINDS", "headline", "sentences"]

KINDS: Final = {
    "none": "nothing established",
    "named": "one cause named",
    "set": "one of a few causes",
    "unknown": "something is wrong, cause unknown",
}
"""Kinds of verdict in words."""
SHOWN: Final = 5
"""Answers whose probabilities are printed."""
LISTED: Final = 6
"""Causes that a sentence lists."""
STRONG: Final = 3.0
"""Log evidence ratio that is called strong evidence (Kass and Raftery 1995)."""
SETTLED: Final = 0.95
"""Probability on average over other runs from which nothing is said of them."""
LITTLE: Final = 0.02
"""Probability below which nobody asks how sure an evidence is."""
UNRELIABLE: Final = 100.0
"""Effective number of draws below which an evidence is not trusted."""


def headline(found: Diagnosis) -> str:
    """Return the verdict in one sentence."""
    verdict = found.verdict
    if verdict.kind == "named":
        shown = [_sized(found, name, found.leading) for name in verdict.names]
        return f"Named {'cause' if len(shown) == 1 else 'causes'}: {'; and '.join(shown)}."
    if verdict.kind == "set":
        shown = [_sized(found, name, ()) for name in verdict.names]
        foreign = verdict.answers.unknown > found.levels.other
        end = ", or something that is in no library" if foreign else ""
        if len(shown) == 1:
            return f"Probably {shown[0]}{end}."
        return f"The cause is one of {len(shown)}: {'; or '.join(shown)}{end}."
    if verdict.kind == "unknown":
        return f"Unknown: {verdict.reason}."
    return f"No cause named: {verdict.reason}."


def _sized(found: Diagnosis, name: str, names: Sequence[str]) -> str:
    one = found.board.candidate(name)
    if one.switch:
        return f"{one.title or name} ({name})"
    span = found.interval(name, names=names)
    size = with_unit(short(found.strength(name, names)), one.unit)
    size += f", 95 % interval {short(span.low)} to {short(span.high)}"
    return f"{one.title or name} ({name} = {size})"


def sentences(found: Diagnosis) -> list[str]:
    """Return everything a reader should know, the most important first."""
    said = [headline(found), _shares(found), _chance(found)]
    said += _lasting(found)
    said += _misfit(found)
    said += [_gained(one) for one in found.gains]
    said += _uncredited(found)
    said += _limits(found)
    said += _doubts(found)
    said.append(next_step(found))
    return said


def _shares(found: Diagnosis) -> str:
    answers = found.verdict.answers
    rows = {**answers.single, **{" and ".join(two): p for two, p in answers.pairs.items()}}
    order = sorted(rows.items(), key=lambda one: -one[1])[:SHOWN]
    shown = [f"{name} {share:.2f}" for name, share in order]
    where = ""
    if answers.where and answers.unknown > 1.0 - found.levels.both:
        place, share = next(iter(answers.where.items()))
        where = (
            f" What is unknown is most likely {place.removeprefix(f'{UNKNOWN} ')} ({share:.2f})."
        )
    return f"Probabilities: {', '.join(shown)}.{where}"


def _chance(found: Diagnosis) -> str:
    chances, levels = found.verdict.chances, found.levels
    if not found.board.candidates:
        return "No effect that the program knows can be missing here, so none was looked for."
    best = max(found.log_ratio(one.name) for one in found.board.candidates)
    return (
        f"The best candidate raises the log evidence by {best:.1f} (p = {chances.p_best:.3f}); "
        f"chance reaches {chances.threshold:.1f} in {100 * levels.chance:.0f} % of "
        f"{levels.studies} imagined studies without any effect, the search over "
        f"{len(found.board.candidates)} candidates and the emulators' errors included."
    )


def _lasting(found: Diagnosis) -> list[str]:
    """Say what other runs might name, where that is not as good as settled."""
    lasting = inclusion_of(found.verdict.chances.lasting)
    shown = [f"{name} {share:.2f}" for name, share in lasting.items() if share > LITTLE][:SHOWN]
    if not shown or max(lasting.values()) > SETTLED:
        return []
    return [f"On average over emulators that other runs would have given: {', '.join(shown)}."]


def _misfit(found: Diagnosis) -> list[str]:
    said = f"The base model itself: p = {found.verdict.chances.p_misfit:.3f}"
    if not found.residuals:
        return [f"{said}."]
    worst = max(found.residuals, key=lambda one: abs(one.z_left_out))
    return [
        f"{said}; furthest from what the other readings predict: {worst.name} of {worst.place}, "
        f"{worst.z_left_out:+.1f} standard errors."
    ]


def _gained(one: Gain) -> str:
    claim = "a gain" if one.claimed else "no gain that chance would not give"
    return (
        f"Held-out test of {' and '.join(one.candidates)}, one place left out at a time: log "
        f"density {one.log_density:+.1f} (chance reaches {one.chance:+.1f}): {claim}. New data of "
        f"the same experiments would gain {one.low:+.1f} to {one.high:+.1f} if it is the cause."
    )


def _limits(found: Diagnosis) -> list[str]:
    blind = [one for one in found.visibility.candidates if not one.visible]
    strong = [one.candidate for one in blind if found.log_ratio(one.candidate) > STRONG]
    said = []
    hidden = [
        one.candidate  # what nothing shows has no strength that it needs
        + (f" (needs {one.detectable:.3g})" if math.isfinite(one.detectable) else "")
        for one in blind
        if one.candidate not in strong
    ]
    if hidden:
        said.append(f"These data cannot show, at any plausible strength: {_listed(hidden)}.")
    same = [
        f"{one.candidate} ({one.instead.parameter} {one.instead.then:.3g} in place of "
        f"{one.instead.now:.3g})"
        for one in found.visibility.candidates
        if one.visible and one.instead and not math.isfinite(one.achieved)
    ]
    if same:
        said.append(f"Other parameters do the same, however strong they are: {_listed(same)}.")
    if strong:
        names = ", ".join(f"{name} ({found.log_ratio(name):+.1f})" for name in strong)
        said.append(
            f"By straight lines these data could not show them, and yet they raise the log "
            f"evidence: {names}. They stay among the probabilities."
        )
    return said


def _listed(names: Sequence[str]) -> str:
    rest = len(names) - LISTED
    return ", ".join(names[:LISTED]) + (f" and {rest} more, see the table" if rest > 0 else "")


def _uncredited(found: Diagnosis) -> list[str]:
    """Say which causes would explain the data only by how little is known of them."""
    lost = found.verdict.answers.doubts
    shown = [f"{name} ({p:.2f})" for name, p in lost.items() if p > found.levels.other][:LISTED]
    if not shown:
        return []
    return [
        f"So few runs tell what they do that nearly anything would fit: {', '.join(shown)}. That "
        "is no evidence of them and counts for something unknown, or for the other cause of a "
        "pair; more runs with them on (--twins N) would decide."
    ]


def _doubts(found: Diagnosis) -> list[str]:
    answers = found.verdict.answers
    counts: dict[tuple[str, ...], float] = {(): answers.none}
    counts |= {(name,): p for name, p in answers.inclusion.items()}
    poor = [
        " and ".join(names) or NONE
        for names, one in found.found.weighed.items()
        if one.size < UNRELIABLE and counts.get(names, 0.0) > LITTLE
    ]
    if not poor:
        return []
    return [f"Fewer than {UNRELIABLE:g} effective draws are behind: {', '.join(poor)}."]
