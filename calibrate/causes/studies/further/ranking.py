"""What further experiments are worth: tried in the engine at a few draws of each leading answer."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from calibrate.causes.diagnosis import Diagnosis
from calibrate.causes.judging.probabilities import UNKNOWN
from calibrate.causes.next_measurement import answer_shares
from calibrate.causes.offers import LEAST, Names, Offer, Prospect, ranked
from calibrate.causes.studies.further.options import Option, options_of
from calibrate.causes.studies.further.registry import Entry
from calibrate.causes.studies.further.trying import FEW, Key, Trying
from calibrate.errors import CalibrationError
from calibrate.questions.core.runs import Runs
from calibrate.runs.runner import Runner
from calibrate.study.model import Study
from liggghts_io import CaseError, CaseSpec

__all__ = ["FURTHER", "OPEN", "Tried", "try_further"]

FURTHER: Final = 60
"""Most runs, where nobody asks for another number."""
OPEN: Final = 0.3
"""Nats from which it is open which answer holds."""
LIKELY: Final = 0.03
"""Probability from which an answer is tried."""
MOST: Final = 5
"""Answers that are tried, at most."""
FIRST_SHARE: Final = 2.0 / 3.0
"""Part of the runs that the first round may take."""


@dataclass(frozen=True)
class Tried:
    """What came of it.

    Attributes
    ----------
    prospect : Prospect
        Measurements and further experiments together.
    runs : int
        How many were asked for.
    """

    prospect: Prospect
    runs: int


def try_further(
    study: Study,
    found: Diagnosis,
    base: Runs,
    runner: Runner,
    entries: Mapping[str, Entry],
    most: int,
    tell: Callable[[str], None],
) -> Tried:
    """Rank further experiments among the measurements, where it is open which answer holds.

    Each is tried at a few draws of every leading answer, and those that lead at a few more.

    Parameters
    ----------
    study : Study
        As it is, without the effects that may be missing.
    found : Diagnosis
    base : Runs
        They tell what a run costs.
    runner : Runner
        Finished runs are read.
    entries : mapping
        From `entries_of`.
    most : int
        Runs, at most.
    tell : callable
        Receives what it costs, before the first run, and what is left out.
    """
    before = found.prospect
    shares = answer_shares(found.verdict.answers)
    answers = _tried(shares)
    if most == 0 or before.entropy <= OPEN or len(answers) < 2:
        return Tried(before, 0)
    batch = FEW * len(answers)
    if most < batch:
        tell(
            f"Further experiments are not tried: {len(answers)} answers lead, and one experiment "
            f"takes {batch} runs; allow as many with --further {batch}"
        )
        return Tried(before, 0)
    trying = Trying.of(study, found, answers, runner)
    first = max(int(FIRST_SHARE * most) // batch, 1)
    chosen, cases = _possible(trying, options_of(study, entries, found, shares), first, tell)
    if not chosen:
        return Tried(before, 0)
    again = (most - batch * len(chosen)) // batch
    _tell_cost(before.entropy, chosen, len(answers), batch, again, base, tell)
    trying.run(cases, chosen)
    offers = _offers(trying, chosen, shares)
    leading = [one.measurement.name for one in ranked(list(offers.values()))[:again]]
    better = [option for option in chosen if option.name in leading]
    more = [trying.cases(option, range(FEW, 2 * FEW)) for option in better]
    trying.run({key: specs for one in more for key, specs in one.items()}, better)
    offers |= _offers(trying, better, shares)
    _tell_rest(chosen, offers, tell)
    whole = ranked([*before.offers, *offers.values()])
    return Tried(Prospect(before.entropy, whole), trying.runs)


def _tried(shares: Mapping[Names, float]) -> tuple[Names, ...]:
    """Return the answers that are tried; what is unknown expects what none does."""
    likely = [names for names, p in shares.items() if p > LIKELY]
    own = [names for names in likely if names != (UNKNOWN,)][:MOST]
    if (UNKNOWN,) in likely and () not in own:
        own = [*own[: MOST - 1], ()]
    return tuple(own)


def _possible(
    trying: Trying, options: Sequence[Option], count: int, tell: Callable[[str], None]
) -> tuple[list[Option], dict[Key, list[CaseSpec]]]:
    """Return the first options of which cases can be made, with these; tell what is left out."""
    chosen: list[Option] = []
    cases: dict[Key, list[CaseSpec]] = {}
    waiting = []
    for option in options:
        if len(chosen) == count:
            waiting.append(option.name)
            continue
        try:
            cases |= trying.cases(option, range(FEW))
        except (CalibrationError, CaseError) as err:
            tell(f"The further experiment {option.name} cannot be tried: {err}")
        else:
            chosen.append(option)
    if waiting:
        tell(f"Not tried for want of runs (--further): {', '.join(waiting)}")
    return chosen, cases


def _tell_cost(
    entropy: float, chosen: Sequence[Option], answers: int, batch: int, again: int, base: Runs,
    tell: Callable[[str], None],
) -> None:  # fmt: skip
    """Say what is run next, and what that takes."""
    runs = batch * (len(chosen) + min(again, len(chosen)))
    minutes = runs * float(base.table["wall_s"].median()) / 60.0
    tell(
        f"Which answer holds is open ({entropy:.2f} nats): {answers} answers are tried in further "
        f"experiments ({', '.join(option.name for option in chosen)}), up to {runs} runs, "
        f"{minutes:.1f} min on one core if each takes as long as those of the study"
    )


def _offers(
    trying: Trying, options: Sequence[Option], shares: Mapping[Names, float]
) -> dict[str, Offer]:
    found = {option.name: trying.offer(option, shares) for option in options}
    return {name: one for name, one in found.items() if one is not None}


def _tell_rest(
    chosen: Sequence[Option], offers: Mapping[str, Offer], tell: Callable[[str], None]
) -> None:
    """Say what became of those that are offered to nobody."""
    failed = [option.name for option in chosen if option.name not in offers]
    if failed:
        tell(f"Too few runs succeeded to judge {', '.join(failed)}")
    poor = [f"{name} ({o.information:.2f})" for name, o in offers.items() if o.information < LEAST]
    if poor:
        tell(f"Tried, and tells less than {LEAST:g} nats: {', '.join(poor)}")
