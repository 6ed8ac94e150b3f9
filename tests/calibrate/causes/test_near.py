"""A cause whose answer is no parabola: its strength comes right, and runs are made near it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from calibrate.causes.studies.near import Near
from calibrate.causes.studies.study_diagnosis import diagnose_runs
from calibrate.causes.studies.twins import TWINS, twin_strengths
from calibrate.causes.studies.what_if import diagnose_again
from calibrate.questions.core.forms import Switch
from liggghts_io import CaseSpec
from liggghts_io.effects import EFFECTS
from tests.calibrate.causes import studies

FLOW = "mass_flow_factor"
TRUTH = 0.08
UNSETTLED = (
    "runs near the strength would narrow its interval",
    "the strength's interval is not to be trusted",
)
KNOWN = "[known.plate_period]\nse = 0.002\n[known.plate_tilt_deg]\nse = 0.05\n"


def bent(strength: float) -> float:
    """Return the part by which times fall; it rises at once and then hardly more."""
    return 0.36 * math.tanh(strength / 0.1)


def run(specs: Sequence[CaseSpec], label: str) -> pd.DataFrame:
    """Run cases on the formulas, with the bent answer to the flow."""
    bent_specs = [
        replace(one, effects={**one.effects, FLOW: bent(one.effects[FLOW])})
        if FLOW in one.effects
        else one
        for one in specs
    ]
    table = studies.run(bent_specs, label)
    return table.assign(case_id=studies.run(specs, label)["case_id"])


@pytest.fixture
def few_causes() -> Iterator[None]:
    """Leave what else might be wrong out, which costs time here."""
    with studies.without(
        EFFECTS.keys() - {FLOW, "plate_tilt_deg", "plate_period", "cohesion_J_m3"}
    ):
        yield


@pytest.mark.long
@pytest.mark.usefixtures("few_causes")
def test_a_strength_comes_right_where_the_answer_is_no_parabola(tmp_path: Path) -> None:
    data = studies.study(tmp_path, {FLOW: bent(TRUTH)}, 5, KNOWN)
    base = studies.base_runs(data)
    rough, found = (
        diagnose_runs(data, base, run, more=more, options=studies.FEW) for more in (0, 24)
    )
    assert rough.found.leading == found.found.leading == (FLOW,)
    # It is far from what was expected, or hardly expected: either way more runs are asked for.
    assert any(words in " ".join(rough.sentences) for words in UNSETTLED)
    assert not any(words in " ".join(found.sentences) for words in UNSETTLED)
    assert rough.added == 0
    assert found.added > 0
    # Whether or not the engine was asked again: answers of any shape are learnt. Where they hardly
    # rise any more, a strength is told by that alone (0.07 to 0.24).
    # One study is looked at, of which a 95 % interval may miss the truth.
    wide, close = (one.found.interval(FLOW, 0.99) for one in (rough, found))
    assert wide.low <= TRUTH <= wide.high
    assert close.low <= TRUTH <= close.high
    again = diagnose_again(
        found.data, found.runs, twins=found.twins, added=found.added,
        options=studies.FEW,
    )  # fmt: skip
    assert again.found.strength(FLOW) == found.found.strength(FLOW)


@pytest.mark.long
@pytest.mark.usefixtures("few_causes")
def test_runs_where_the_evidence_is_uncertain_have_strengths_that_are_probable(
    tmp_path: Path,
) -> None:
    """Beside them those of all other twins are the usual ones, whatever the data say."""
    made: list[float] = []

    def watched(specs: Sequence[CaseSpec], label: str) -> pd.DataFrame:
        if label == "Runs where the evidence is uncertain":
            made.extend(one.effects[FLOW] for one in specs if one.effects.get(FLOW))
        return run(specs, label)

    data = studies.study(tmp_path, {FLOW: bent(TRUTH)}, 5, KNOWN)
    diagnose_runs(data, studies.base_runs(data), watched, more=16, options=studies.FEW)
    usual = {abs(x) for x in twin_strengths(EFFECTS[FLOW], Switch(FLOW, 0.05, -0.3, 0.3), TWINS)}
    assert made
    assert not usual & set(made)
    assert min(made) > 0.0  # the data leave no doubt about the sign


def test_twins_near_a_strength_lie_around_it_within_the_limits() -> None:
    switch = Switch(FLOW, 0.05, -0.3, 0.3)
    low = Near(-0.2, 0.5)
    x = low.strengths(switch, TWINS)
    assert low.holds(x).all()
    assert x.min() < -0.25
    assert x.max() > -0.15
    assert Near(0.28, 0.5).strengths(switch, TWINS).max() <= 0.3
    wide = np.array(twin_strengths(EFFECTS[FLOW], switch, TWINS))
    assert not low.holds(wide[wide > 0.0]).any()
