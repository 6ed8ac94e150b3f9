"""Sentences for a reader: what is wrong, what the data can tell, what to measure next."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from calibrate.causes.diagnosis import Diagnosis
from calibrate.causes.gain import Gain
from calibrate.causes.verdict import NONE, UNKNOWN

__all__ = ["KINDS", "headline", "next_measurement", "sentences", "short"]

KINDS: Final = {
    "none": "nothing established",
    "named": "one cause named",
    "group": "causes that the data cannot tell apart",
    "unknown": "something is wrong, cause unknown",
}
"""Kinds of verdict in words."""
SHOWN: Final = 5
"""Answers whose probabilities are printed."""
STRONG: Final = 3.0
"""Log evidence ratio that is called strong evidence (Kass and Raftery 1995)."""
STEADY: Final = 0.5
"""Sway of a log evidence ratio, in nats, that is not worth a word."""
UNRELIABLE: Final = 100.0
"""Effective number of draws below which an evidence is not trusted."""


def headline(found: Diagnosis) -> str:
    """Return the verdict in one sentence."""
    verdict = found.verdict
    if verdict.kind == "named":
        return f"Named cause: {_sized(found, verdict.names[0])}."
    if verdict.kind == "group":
        shown = [_sized(found, name) for name in verdict.names]
        end = ", or a cause that is no candidate" if UNKNOWN in verdict.credible else ""
        return f"Causes that cannot be told apart: {'; or '.join(shown)}{end}."
    if verdict.kind == "unknown":
        return f"Unknown: {verdict.reason}."
    return f"No cause named: {verdict.reason}."


def _sized(found: Diagnosis, name: str) -> str:
    one = found.board.members([name])[0]
    span = found.interval(name)
    unit = f" {one.unit}" if one.unit not in ("", "-") else ""
    size = f"{short(found.strength(name))}{unit}, 95 % interval {short(span.low)} to "
    size += short(span.high)
    return f"{one.title or name} ({name} = {size})"


def short(value: float) -> str:
    """Return three digits, without a power of ten where the number is an everyday one.

    Examples
    --------
    >>> short(71_966.0), short(0.004567), short(-5.0)
    ('72000', '0.00457', '-5')
    """
    return f"{float(f'{value:.3g}'):.9g}"


def sentences(found: Diagnosis) -> list[str]:
    """Return everything a reader should know, the most important first."""
    said = [headline(found), _shares(found), _chance(found)]
    said += _misfit(found)
    said += [_gained(one) for one in found.gains]
    said += _limits(found)
    said += _doubts(found)
    said.append(next_measurement(found))
    return said


def _shares(found: Diagnosis) -> str:
    verdict = found.verdict
    shown = [f"{name} {share:.2f}" for name, share in list(verdict.probabilities.items())[:SHOWN]]
    held = ", ".join(verdict.credible)
    share = f"{100 * found.levels.credible:.0f} %"
    return f"Probabilities: {', '.join(shown)}. The smallest set that holds {share}: {held}."


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
        f"Held-out test of {' and '.join(one.candidates)}, one place left out at a time: residuals "
        f"{one.z_before:.2f} to {one.z_after:.2f} standard deviations, log density "
        f"{one.log_density:+.1f} (chance reaches {one.chance:+.1f}): {claim}."
    )


def _limits(found: Diagnosis) -> list[str]:
    blind = [one for one in found.visibility.candidates if not one.visible]
    strong = [one.candidate for one in blind if found.log_ratio(one.candidate) > STRONG]
    said = []
    if len(strong) < len(blind):
        names = ", ".join(
            f"{one.candidate} (needs {one.detectable:.3g})"
            for one in blind
            if one.candidate not in strong
        )
        said.append(f"These data cannot show, at any plausible strength: {names}.")
    if strong:
        names = ", ".join(f"{name} ({found.log_ratio(name):+.1f})" for name in strong)
        said.append(
            f"By straight lines these data could not show them, and yet they raise the log "
            f"evidence: {names}. They stay among the probabilities."
        )
    return said


def _doubts(found: Diagnosis) -> list[str]:
    said = []
    best = max(found.sways, key=found.log_ratio, default="")
    if best and found.sways[best] > STEADY:
        said.append(
            f"With other runs behind the emulators, as many as here, the log evidence ratio of "
            f"{best} ({found.log_ratio(best):+.1f}) would differ by about {found.sways[best]:.1f}; "
            "more runs near the optimum make it sharper."
        )
    poor = [" and ".join(names) or NONE for names, one in found.weighed.items()
            if one.size < UNRELIABLE]  # fmt: skip
    size = found.verdict.chances.size
    if size < UNRELIABLE:
        poor.append(f"the imagined studies ({size:.0f}), so their p are rough")
    if poor:
        said.append(f"Fewer than {UNRELIABLE:g} effective draws are behind: {', '.join(poor)}.")
    return said


def next_measurement(found: Diagnosis) -> str:
    """Return what would settle most of what is open."""
    verdict = found.verdict
    if verdict.kind in ("group", "named"):
        return _settling(found, verdict.names)
    if verdict.kind == "unknown":
        where, share = max(verdict.where.items(), key=lambda pair: pair[1])
        place = where.removeprefix(f"{UNKNOWN} at ")
        return (
            f"Next: measure the apparatus behind {place} again and compare it with the study's "
            f"values: if no candidate is the cause, it acts there with a share of {share:.2f}."
        )
    shares = verdict.probabilities
    open_ones = [one.name for one in found.board.candidates if shares[one.name] > 0.0]
    best = sorted(open_ones, key=lambda name: -shares[name])[:1]
    return _settling(found, best) if best else "Next: repeat the reading that is furthest off."


def _settling(found: Diagnosis, names: Sequence[str]) -> str:
    members = found.board.members(names)
    hints = dict.fromkeys(one.settled_by or f"measure {one.name}" for one in members)
    tables = ", ".join(dict.fromkeys(one.effect for one in members))
    return f"Next: {'; '.join(hints)}; give it under [known] as {tables}, and repeat."
