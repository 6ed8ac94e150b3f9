"""Which funnel fed which plate: the paper's flows (Table B.9) as read, exchanged, and one for both.

    python -m benchmarks.paper.flows

The accessible copy prints experiment (d) before (c), so that the columns might be the other way
round. Each reading is the base model with the conveyor's flows at fixed factors; its log evidence,
by Laplace's method about the mode, is told beside that of the flows as they are read. Stored runs
are read, among them those with another flow, and nothing is run.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
from threadpoolctl import threadpool_limits

from benchmarks.paper import sources
from calibrate.causes.candidates import Board
from calibrate.causes.strengths.prior import StrengthPrior
from calibrate.causes.studies.from_study import with_effects
from calibrate.causes.studies.work import Work, silent, unseen
from calibrate.causes.weighing.modes import mode_near
from calibrate.errors import BugError
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.runs import read_stored_curve
from calibrate.questions.core.stored import tabled_runs
from liggghts_io import CaseSpec

FLAT: Final = "mass_flow_factor:conveyor_flat"
GLUED: Final = "mass_flow_factor:conveyor_glued"
STARTS: Final = 64
"""Points about the prior's middle from which the highest mode is looked for."""
SPREAD: Final = 0.5
"""Prior deviations by which they lie apart."""


@dataclass(frozen=True)
class Asked:
    """A study, the grains whose flows tell the factors, and its tables of runs."""

    study: str
    grains: tuple[str, ...]
    tables: tuple[Path, ...]


_PROPPANTS: Final = tuple(
    sources.CASES / "runs" / f"{name}.csv.gz" for name in ("quick", "near", "causes")
)
_ONE: Final = (sources.ROOT / "cases" / "challenge" / "runs" / "one_material.csv.gz",)
ASKED: Final = (
    Asked("hsp13", ("Carbo HSP13",), _PROPPANTS),
    Asked("hsp13_one_diameter", ("Carbo HSP13",), _ONE),
    Asked("finer", ("Carbo HSP16/30", "Carbo HSP20/40", "Carbo HSP30/60"), _PROPPANTS),
)


def readings(grains: tuple[str, ...]) -> dict[str, tuple[float, float]]:
    """Return the readings of Table B.9: factors less one on flat and on glued plates.

    Of several grains the mean, which is right for those that are asked: their ratios are alike.
    """
    table = sources.table("funnel_mass_flow").set_index("particle").loc[list(grains)]
    flat = float((table["glued_c_g_s"] / table["flat_d_g_s"]).mean()) - 1.0
    glued = float((table["flat_d_g_s"] / table["glued_c_g_s"]).mean()) - 1.0
    return {
        "as read": (0.0, 0.0),
        "columns exchanged": (flat, glued),
        "glued plate's funnel for all": (flat, 0.0),
        "flat plates' funnel for all": (0.0, glued),
    }


def board(asked: Asked) -> Board:
    """Return what a diagnosis weighs, from stored runs."""
    data = sources.study(asked.study)
    wider = with_effects(data)
    forms = forms_of(wider)
    work = Work(data, wider, forms, _nothing, read_stored_curve, silent, 0, 0, unseen)
    return work.board(work.learn(tabled_runs(data, forms, *asked.tables)))


def _nothing(specs: Sequence[CaseSpec], _label: str) -> pd.DataFrame:
    msg = f"{len(specs)} runs were asked for where stored ones are all there is"
    raise BugError(msg)


def evidences(found: Board, factors: dict[str, tuple[float, float]]) -> dict[str, float]:
    """Return the log evidence of each reading, the highest of its modes."""
    members = found.members((FLAT, GLUED))
    rng = np.random.default_rng(found.problem.space.size)
    starts = [np.zeros(found.problem.space.size)]
    starts += list(SPREAD * rng.normal(size=(STARTS - 1, found.problem.space.size)))

    def highest(at: tuple[float, float]) -> float:
        fixed = [_fixed(x / one.scale) for x, one in zip(at, members, strict=True)]
        return max(mode_near(found.problem, z, members, fixed).log_evidence for z in starts)

    return {name: highest(at) for name, at in factors.items()}


def _fixed(strength: float) -> StrengthPrior:
    """Return that a strength is known."""
    return StrengthPrior(strength, strength, 1.0)


def main() -> None:
    """Print every study's readings."""
    for asked in ASKED:
        factors = readings(asked.grains)
        with threadpool_limits(limits=1):
            found = evidences(board(asked), factors)
        for name, (flat, glued) in factors.items():
            told = found[name] - found["as read"]
            print(
                f"{asked.study:20} {name:30} {flat:+.3f} {glued:+.3f} {told:+6.1f} nats", flush=True
            )


if __name__ == "__main__":
    main()
