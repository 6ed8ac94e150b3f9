"""Sentences for a reader: what is wrong, what the data can tell, what to measure next."""

from __future__ import annotations

from collections.abc import Sequence

from calibrate.diagnose.pipeline import Diagnosis
from calibrate.diagnose.residuals import Residual
from calibrate.diagnose.verify import root_mean_square
from calibrate.significance import significant, weighed

KINDS = {
    "none": "nothing significant",
    "named": "one cause named",
    "group": "a group of causes that the data cannot tell apart",
    "unknown": "something is wrong, cause unknown",
}


def headline(found: Diagnosis) -> str:
    """Return the verdict in one sentence."""
    verdict = found.verdict
    if verdict.kind == "named":
        return f"Named cause: {_sized(found, verdict.names[0])}."
    if verdict.kind == "group":
        shown = [_sized(found, name) for name in verdict.names]
        if len(shown) > 2:  # sizes of many stand in the table
            shown = list(verdict.names)
        return f"Causes that cannot be told apart: {'; or '.join(shown)}."
    if verdict.kind == "unknown":
        return f"Unknown: {verdict.reason}."
    return f"No cause named: {verdict.reason}."


def _sized(found: Diagnosis, name: str) -> str:
    candidate = next(c for c in found.problem.candidates if c.name == name)
    low, high = found.verdict.intervals[name].interval95
    strength = next(s.strength for s in found.verdict.suspects if s.candidate == name)
    title = candidate.title or name
    return f"{title} ({name} = {strength:.3g}, 95 % interval {low:.3g} to {high:.3g})"


def sentences(found: Diagnosis) -> list[str]:
    """Everything a reader should know, most important first."""
    said = [headline(found), _misfit(found), _rates(found)]
    said += _limits(found)
    said += _gains(found)
    said += contradiction(found.verdict.kind, found.engine_before)
    if not found.local.settled:
        said.append(
            "The joint fit left the runs made so far and the number of designs was used up: "
            "numbers below are extrapolated there, repeat with more rounds or a wider range."
        )
    held = [
        p.name for p, h in zip(found.problem.parameters, found.local.base.held, strict=True) if h
    ]
    if held:
        said.append(f"At the limit of their range: {', '.join(held)}.")
    said.append(next_measurement(found))
    return said


def _misfit(found: Diagnosis) -> str:
    worst = max(found.residuals, key=lambda r: abs(r.z_left_out))
    return (
        f"Base model, all parameters refitted: misfit {found.local.base.power:.1f} for "
        f"{len(found.residuals)} values (p = {found.verdict.p_misfit:.3f}); furthest from what "
        f"the other values predict: {worst.name}, {worst.z_left_out:+.1f} standard errors."
    )


def _rates(found: Diagnosis) -> str:
    verdict, levels = found.verdict, found.levels
    return (
        f"A candidate is considered from a gain of {verdict.threshold:.1f} on (best here "
        f"{verdict.best_gain:.1f}, p = {verdict.p_search:.3f}): without any effect that happens "
        f"in {100 * levels.search:.0f} % of {levels.draws} imagined studies, the search over "
        f"{len(found.problem.candidates)} candidates included."
    )


def _limits(found: Diagnosis) -> list[str]:
    blind = [v for v in found.absorption.candidates if not v.visible]
    if not blind:
        return []
    names = ", ".join(f"{v.candidate} (needs {v.detectable:.3g})" for v in blind)
    return [f"These data cannot show, at any plausible strength: {names}."]


def _gains(found: Diagnosis) -> list[str]:
    said = []
    for one in found.gains:
        claim = "a gain" if one.claimed else "no gain that chance would not give"
        said.append(
            f"Held-out test of {one.candidate}, one experiment left out at a time: residuals "
            f"{one.rms_before:.2f} to {one.rms_after:.2f} standard deviations, log density "
            f"{one.elpd:+.1f} (chance reaches {one.null95:+.1f}): {claim}."
        )
    if found.engine_before:
        text = (
            f"Engine at the refitted base model, fresh seeds: residuals "
            f"{root_mean_square(found.engine_before):.2f} standard errors"
        )
        if found.engine_after:
            after = root_mean_square(found.engine_after)
            text += f"; with {found.verdict.names[0]} {after:.2f}"
            if after >= root_mean_square(found.engine_before):
                text += ": the engine does not confirm the gain, so the cause is not established"
        said.append(text + ".")
    return said


def contradiction(kind: str, rows: Sequence[Residual]) -> list[str]:
    """Say where the engine itself misses what the surrogates' residuals found explained.

    Parameters
    ----------
    kind : str
        Kind of the verdict; only "none" claims that errors explain the residuals.
    rows : sequence of Residual
        The engine at the refitted parameters.
    """
    missed = [r for r in rows if significant(r.z)] if kind == "none" else []
    return [
        f"The engine itself misses {r.name}: {weighed(r.z, errors='measurement and simulation')}; "
        "the verdict rests on surrogates and does not hold for this value."
        for r in missed
    ]


def next_measurement(found: Diagnosis) -> str:
    """Return what would settle most of what is open."""
    verdict = found.verdict
    if verdict.kind == "group":
        suspected = [c for c in found.problem.candidates if c.name in verdict.names]
        hints = dict.fromkeys(c.settled_by for c in suspected if c.settled_by)
        tables = ", ".join(f"[known.{e}]" for e in dict.fromkeys(c.effect for c in suspected))
        return f"To tell them apart, measure: {'; '.join(hints)}; give it as {tables} and repeat."
    if verdict.kind == "unknown":
        worst = max(found.residuals, key=lambda r: abs(r.z_left_out)).name
        return (
            f"Next: measure the apparatus behind {worst} again and compare it with the study's "
            "[apparatus] values; this value is furthest off, and no candidate acts that way."
        )
    if not any(o.on_curve for o in found.problem.observables):
        return (
            "Next measurement: keep the whole mass-time curve of the conveyor instead of one time; "
            "it costs nothing and separates flow, speed and delay."
        )
    absorbed = max(found.absorption.candidates, key=lambda v: v.absorbed, default=None)
    if absorbed is None or not absorbed.bias:
        return "Next measurement: repeat the value that lies furthest off."
    parameter = max(absorbed.bias, key=lambda name: abs(absorbed.bias[name]) * absorbed.limit)
    return (
        f"Next measurement: an independent value of {parameter}; it absorbs most of "
        f"{absorbed.candidate} ({100 * absorbed.absorbed:.0f} % of its signature is imitated)."
    )
