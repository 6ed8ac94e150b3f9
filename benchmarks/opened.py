"""Say what the levels of a verdict and the width of intervals do to suites that are opened.

    python -m benchmarks.opened

From the forecasts and truths in cases/challenge: names that today's level of one name
(`calibrate/causes/judging/levels.py`) lets stand of those that stood at 0.9, and strengths inside
of their 90 % intervals, as forecast and spread by today's factor
(`calibrate/causes/strengths/widened.py`). Suites that were forecast with these already are left
out.
"""

from __future__ import annotations

import json
import zipfile
from pathlib import Path
from typing import Final

from calibrate.causes.judging.levels import Levels
from calibrate.causes.strengths.widened import FACTOR
from calibrate.challenge.cases import Case
from calibrate.challenge.scores import WEAK

SUITES: Final = Path(__file__).resolve().parents[1] / "cases" / "challenge"
NAMED: Final = ("suite_4", "suite_5", "suite_6")
SIZED: Final = ("suite_5", "suite_6")
"""Suites whose strengths are told by the data alone, and answers bend, as today."""


def cases_of(suite: str, method: str = "ours", archive: str = "forecasts.zip") -> list[Case]:
    """Return the studies of a suite with what a method said of them, as far as it said anything."""
    folder = SUITES / suite
    truths = json.loads((folder / "truths.json").read_text(encoding="utf-8"))
    found = []
    with zipfile.ZipFile(folder / archive) as packed:
        for member in packed.namelist():
            path = Path(member)
            if path.parent.name == method and path.suffix == ".json":
                said = json.loads(packed.read(member))
                found.append(Case(truths[path.stem], None if "failed" in said else said))
    return found


def stands(one: Case, levels: Levels) -> bool:
    """Tell whether a name would stand: alone, or two side by side."""
    least = levels.name if len(one.names) == 1 else levels.both
    return all(one.probability(name) > least for name in one.names)


def inside(one: Case, factor: float) -> list[bool]:
    """Tell of each hidden strength that was forecast whether its interval holds it."""
    told = one.forecast["strengths"] if one.forecast else {}
    found = []
    for hidden in one.truth["hidden"]:
        if hidden["name"] in told and hidden["strength"]:
            low, middle, high = told[hidden["name"]]
            away = hidden["strength"] - middle
            found.append(factor * (low - middle) <= away <= factor * (high - middle))
    return found


def main() -> None:
    """Print both."""
    levels = Levels()
    cases = {suite: cases_of(suite) for suite in (*NAMED, *SIZED)}
    for suite in NAMED:
        named = [one for one in cases[suite] if one.verdict == "named"]
        false = [one for one in named if one.kind in ("nothing", "foreign")]
        right = [
            one for one in named
            if one.kind == "single" and one.size >= WEAK and one.hidden[0] in one.names
        ]  # fmt: skip
        blameless = sum(one.kind in ("nothing", "foreign") for one in cases[suite])
        print(
            f"{suite}: of {blameless} studies without a cause of the library {len(false)} were "
            f"named, {sum(stands(one, levels) for one in false)} would be; of {len(right)} right "
            f"names from 5.6 standard errors on {sum(stands(one, levels) for one in right)} stand"
        )
    for suite in SIZED:
        each = [[ok for one in cases[suite] for ok in inside(one, f)] for f in (1.0, FACTOR)]
        print(
            f"{suite}: {sum(each[0])} of {len(each[0])} strengths in their 90 % intervals, "
            f"{sum(each[1])} where these are {FACTOR:g} times as wide"
        )


if __name__ == "__main__":
    main()
