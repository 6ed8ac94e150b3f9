"""Cases for the statistics of the diagnosis: what is hidden, and what the verdict made of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from calibrate.diagnose import Candidate, DesignOptions, Diagnosis, Levels, Options, diagnose
from tests.calibrate.diagnose import stand_in

# Half of what an ordinary study runs; the stand-in scatters less than a quick engine run.
OPTIONS = Options(
    design=DesignOptions(seeds=1, centre_seeds=4, effect_seeds=2),
    levels=Levels(draws=300),
)
EFFECT_OF = {c.name: c.effect for c in (*stand_in.LIBRARY, stand_in.TWIN)}
# Smallest strength seen with 80 % power, median over studies without effect (see `limits`).
DETECTABLE = {
    "plate_tilt_deg": 0.85,
    "mass_flow_factor": 0.067,
    "cohesion_J_m3": 0.45,
    "size_distribution": 0.5,
    "wall_adhesion_J_m3": 1.3,
}


@dataclass(frozen=True)
class Outcome:
    """One case in one row."""

    seed: int
    hidden: str
    strength: float
    kind: str
    names: str
    p_misfit: float
    p_search: float
    fitted: float
    low95: float
    high95: float
    runs: int

    @property
    def named_wrong(self) -> bool:
        """Whether a single cause was named that is not the hidden one."""
        return self.kind == "named" and self.names != self.hidden

    @property
    def contains_truth(self) -> bool:
        """Whether the hidden cause is the name or in the group."""
        return self.hidden in self.names.split("+")

    @property
    def covered(self) -> bool:
        """Whether the interval of the hidden cause holds its strength."""
        return self.low95 <= self.strength <= self.high95


def truth(rng: np.random.Generator, width: float = 0.1) -> dict[str, float]:
    """Parameters of the imagined material, off the staged result by up to `width` of the range."""
    base = stand_in.problem((), stand_in.TRUTH)
    u = np.clip(base.start + rng.uniform(-width, width, len(base.start)), 0.02, 0.98)
    return base.theta(u)


def run(
    seed: int,
    effects: Mapping[str, float],
    library: tuple[Candidate, ...] = stand_in.LIBRARY,
    *,
    curve: bool = True,
    options: Options = OPTIONS,
) -> Diagnosis:
    """Diagnose one imagined study with `effects` hidden in its data."""
    rng = np.random.default_rng(seed)
    observables = stand_in.bench(truth(rng), effects, rng, curve=curve)
    problem = stand_in.problem(observables, stand_in.TRUTH, library)
    return diagnose(problem, stand_in.StandIn(seed), rng=rng, options=options)


def outcome(seed: int, hidden: str, strength: float, found: Diagnosis) -> Outcome:
    """Summarise a diagnosis."""
    verdict = found.verdict
    low, high, fitted = np.nan, np.nan, np.nan
    if hidden in verdict.intervals:
        low, high = verdict.intervals[hidden].interval95
        fitted = next(s.strength for s in verdict.suspects if s.candidate == hidden)
    return Outcome(
        seed, hidden, strength, verdict.kind, "+".join(verdict.names),
        verdict.p_misfit, verdict.p_search, fitted, low, high, found.local.runs,
    )  # fmt: skip


def strength_at(name: str, factor: float) -> float:
    """Strength at a multiple of the detection limit, kept inside what is physically possible."""
    upper = next(c.upper for c in stand_in.LIBRARY if c.name == name)
    return min(factor * DETECTABLE[name], 0.9 * upper)


def planted(seed: int, name: str, strength: float) -> Outcome:
    """Hide one candidate of the library and diagnose."""
    return outcome(seed, name, strength, run(seed, {EFFECT_OF[name]: strength}))


def nothing(seed: int) -> Outcome:
    """Hide nothing and diagnose."""
    return outcome(seed, "", 0.0, run(seed, {}))


def foreign(seed: int, strength: float) -> Outcome:
    """Hide a period error, which is not in the library, and diagnose."""
    return outcome(seed, "period", strength, run(seed, {"period": strength}))


def limits(seeds: range) -> dict[str, float]:
    """Median detection limit of every candidate over studies without effect."""
    tables = [run(s, {}).absorption for s in seeds]
    names = [v.candidate for v in tables[0].candidates]
    return {n: float(np.median([t.of(n).detectable for t in tables])) for n in names}
