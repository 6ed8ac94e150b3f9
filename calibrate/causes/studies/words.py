"""Sentences on what the engine itself says, among those of the diagnosis."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

from scipy.stats import chi2

from calibrate.causes.diagnosis import Diagnosis
from calibrate.causes.studies.verify import SURE, EngineSays, root_mean_square
from calibrate.causes.told.words import headline, sentences
from calibrate.questions.joint.check import CheckRow
from calibrate.significance import shown, significant, weighed

__all__ = ["contradiction", "study_sentences"]

BOTH: Final = "measurement and simulation"
NAMED: Final = 5
"""Missed targets that a sentence names."""
NO_LUCK: Final = 1e-3
"""Probability below which what the engine misses is no luck."""


def study_sentences(found: Diagnosis, before: Sequence[CheckRow], after: EngineSays) -> list[str]:
    """Return everything a reader should know: the verdict first, what to measure next last.

    Parameters
    ----------
    found : Diagnosis
    before : sequence of CheckRow
        The engine at the best values of the base model.
    after : EngineSays
        With the best named cause.
    """
    *said, last = sentences(found)
    said[0] = _verdict(found, before)
    said += _engine(found, before, after)
    said += _unsure(before)
    said += contradiction(found.verdict.kind, before)
    return [*said, last]


def _verdict(found: Diagnosis, before: Sequence[CheckRow]) -> str:
    """Return the verdict in one sentence; "none" is none where the engine misses by too much."""
    squares = [row.z**2 for row in before if math.isfinite(row.z)]
    lucky = not squares or chi2.sf(sum(squares), len(squares)) > NO_LUCK
    if found.verdict.kind != "none" or lucky:
        return headline(found)
    return (
        f"Not told yet: no cause is named, but at the best values the engine itself is off by "
        f"{root_mean_square(before):.1f} standard errors of {BOTH} (root mean square of "
        f"{len(squares)} targets); runs near these values would tell more."
    )


def _engine(found: Diagnosis, before: Sequence[CheckRow], says: EngineSays) -> list[str]:
    if not before:
        return []
    base = root_mean_square(before)
    text = (
        f"Engine at the base model's best values, fresh seeds: residuals {base:.2f} standard errors"
    )
    after = says.rows
    if after:
        cause = root_mean_square(after)
        text += f"; with {' and '.join(found.leading)} {cause:.2f}"
        if not cause < base:
            text += ": the engine does not confirm the gain, so the cause is not established"
        missed = [f"{row.name} ({shown(-row.z)})" for row in after if significant(row.z)]
        if missed:
            text += (
                f". With it the engine still misses {', '.join(missed)}: the cause does not "
                "explain these, or the emulators know it from too few runs (--twins, --more)"
            )
    if not says.expected:
        text += (
            f". It is {says.off:.1f} standard errors from what was expected of it: the strength's "
            "interval is not to be trusted (--more)"
        )
    elif not says.settled:
        text += (
            f". What was expected of it is known to {says.unsure:.1f} standard errors only: runs "
            "near the strength would narrow its interval (--more)"
        )
    return [f"{text}."]


def _unsure(rows: Sequence[CheckRow]) -> list[str]:
    """Say which values emulators know so badly where the base model fits that little rests there.

    In errors of measurement and engine together, as everywhere where the engine is asked.
    """
    errors = {
        row.name: math.sqrt(row.error_ratio)
        * row.measured_se
        / math.hypot(row.measured_se, row.simulated_se)
        for row in rows
        if math.isfinite(row.simulated_se)
    }
    loose = [name for name, error in errors.items() if error > SURE]
    if not loose:
        return []
    worst = max(loose, key=errors.__getitem__)
    return [
        f"At these values the emulators know {len(loose)} of {len(rows)} targets to more than "
        f"{SURE:.0f} standard errors of {BOTH} only ({worst}: {errors[worst]:.0f}): runs near them "
        "could change the answer."
    ]


def contradiction(kind: str, rows: Sequence[CheckRow]) -> list[str]:
    """Say where the engine itself misses what the emulators' residuals found explained.

    Parameters
    ----------
    kind : str
        Kind of the verdict; only "none" claims that errors explain the residuals.
    rows : sequence of CheckRow
        The engine at the best values of the base model.
    """
    missed = [row for row in rows if significant(row.z)] if kind == "none" else []
    if not missed:
        return []
    worst = sorted(missed, key=lambda row: -abs(row.z))
    named = [f"{row.name} ({weighed(-row.z, errors=BOTH)})" for row in worst[:1]]
    named += [f"{row.name} ({shown(-row.z)})" for row in worst[1:NAMED]]
    if len(worst) > NAMED:
        named.append(f"{len(worst) - NAMED} more")
    these = "this value" if len(worst) == 1 else "these values"
    return [
        f"The engine itself misses {', '.join(named)}; the verdict rests on emulators and does not "
        f"hold for {these}."
    ]
