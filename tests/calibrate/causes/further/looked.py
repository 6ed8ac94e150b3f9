"""Two causes that look alike, and what is asked of a diagnosis that cannot tell them apart."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np

from calibrate.causes.candidates import Candidate
from calibrate.causes.information import entropy
from calibrate.causes.judging.probabilities import UNKNOWN, Answers
from calibrate.causes.offers import Feasible, Offer, Outcome, Prospect
from calibrate.causes.studies.further.registry import Entry
from tests.calibrate.causes import studies
from tests.calibrate.questions.planted import TRUTH

PERIOD, FLOW, ADHESION = studies.PERIOD, "mass_flow_factor", "wall_adhesion_J_m3"
SIZES = {PERIOD: 0.15, FLOW: -0.15, f"{FLOW}:conveyor_flat": -0.15, f"{ADHESION}:steel": 500.0,
         ADHESION: 500.0}  # fmt: skip
"""Strengths; those of period and flow do the same to the conveyor as it is."""
DRUM = Entry(words="a drum", hours=0.5, experiment="drum",
             se={"angle_slow_deg": 0.5, "angle_fast_deg": 0.5})  # fmt: skip
FASTER = Entry(words="another frequency", hours=0.5, experiment="conveyor",
               times={"period_s": 0.8}, se={"t100_s": 0.1})  # fmt: skip
ALUMINA = Entry(words="another wall", hours=1.0, experiment="conveyor", wall="alumina",
                se={"t100_s": 0.1})  # fmt: skip
BEADS = Entry.model_validate({
    "words": "other grains", "hours": 1.0, "experiment": "heap", "se": {"angle_deg": 0.3},
    "particle": {"name": "beads", "d32_um": 1000.0, "density_kg_m3": 2500.0},
})  # fmt: skip
LOOKED = {(PERIOD,): 0.55, (FLOW,): 0.35, (): 0.06, (UNKNOWN,): 0.04}


def diagnosis(shares: dict[tuple[str, ...], float]):
    """Return what is asked of a diagnosis: answers, their draws, and what could be measured."""
    rng = np.random.default_rng(8)
    middle = np.array([TRUTH[name] for name in studies.FREE])

    def samples(names):
        values = middle + 0.01 * rng.standard_normal((2000, len(middle)))
        sizes = np.array([SIZES.get(name, 1.0) for name in names])
        return values, sizes * (1.0 + 0.05 * rng.standard_normal((2000, len(names))))

    drawn = {names: samples(names) for names in shares if names != (UNKNOWN,)}
    single = {"none": 0.0, UNKNOWN: 0.0}
    single |= {names[0] if names else "none": p for names, p in shares.items()}
    timed = Feasible(PERIOD, "a stopwatch", "-", 0.002, 2.0, PERIOD, frozenset({1}))
    by_hand = Offer(timed, 0.4, (Outcome((0.15,), {PERIOD: 1.0}),))
    return SimpleNamespace(
        prospect=Prospect(entropy(list(shares.values())), (by_hand,)),
        verdict=SimpleNamespace(kind="set", names=(), answers=Answers(single, {}, {})),
        seed=3,
        samples=drawn.__getitem__,
        board=SimpleNamespace(
            members=lambda names: tuple(
                Candidate(name, name.partition(":")[0], 1.0, -9.0, 9.0) for name in names
            )
        ),
    )
