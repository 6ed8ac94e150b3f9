"""Say what could be told at most of a suite's causes, from its runs and its data.

    python -m benchmarks.limit [SUITE]

From the forecasts of `bulkcal challenge forecast --method limit`, in which the diagnosis judges
data that its own emulators give at the truth, with the errors that they state. They are kept for
the causes that are hidden alone from 4 standard errors on and for all pairs, where they exist.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Final

from benchmarks.opened import cases_of
from calibrate.challenge.cases import Case
from calibrate.challenge.scores import SMALL_SET, STRONG, WEAK

SUITE: Final = "suite_7"
ARCHIVE: Final = "limit.zip"


def right(cases: Sequence[Case]) -> int:
    """Return how many causes are named, or in a set of two."""
    return sum(one.hidden[0] in one.names and len(one.names) <= SMALL_SET for one in cases)


def main(suite: str = SUITE) -> None:
    """Print the limit beside what the diagnosis has told of the same studies."""
    told = {"limit": cases_of(suite, "limit", ARCHIVE), "ours": cases_of(suite)}
    for method, cases in told.items():
        alone = [one for one in cases if one.kind == "single"]
        pairs = [one for one in cases if one.kind == "pair"]
        weak = [one for one in alone if WEAK <= one.size < STRONG]
        strong = [one for one in alone if one.size >= STRONG]
        hard = [one for one in pairs if one.size >= STRONG]
        seen = sum(one.hidden[0] in one.names for one in weak)
        chance = sum(one.probability(one.hidden[0]) for one in weak) / max(len(weak), 1)
        print(
            f"{method}: at 5.6 {right(weak)} of {len(weak)} right, {seen} in the set, probability "
            f"{chance:.2f}; from 11 on {right(strong)} of {len(strong)}; pairs at 11 whole "
            f"{sum(set(one.names) == set(one.hidden) for one in hard)} of {len(hard)}, one of both "
            f"{sum(bool(set(one.names) & set(one.hidden)) for one in pairs)} of {len(pairs)}"
        )


if __name__ == "__main__":
    main(*sys.argv[1:])
