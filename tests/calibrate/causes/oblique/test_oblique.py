"""A published misfit, Kharaz's oblique impacts: its cause is named with its size, or is unknown.

The runs are those of `tests/calibrate/causes/oblique/runs.py`; the engine is not asked here.
"""

from __future__ import annotations

from calibrate.causes.diagnosis import Diagnosis, Options
from calibrate.causes.judging.levels import Levels
from calibrate.causes.studies.what_if import diagnose_again
from calibrate.causes.told.words import sentences
from calibrate.causes.weighing.evidences import Effort
from calibrate.study.data import load_data
from tests.calibrate.causes import studies
from tests.calibrate.causes.oblique.runs import STUDY, read_runs
from tests.paths import ROOT

RUNS = ROOT / "tests" / "data" / "causes" / "oblique_runs.csv.gz"
STIFFNESS = "tangential_stiffness"
BEST = -0.27
"""Of single impacts integrated for themselves: `python benchmarks/causes/oblique_terms.py`."""
OPTIONS = Options(Levels(studies=200), held_out=False, effort=Effort(60.0, 2))


def _diagnosed() -> Diagnosis:
    data = load_data(STUDY)
    runs = read_runs(data, RUNS)
    known = runs.where(
        [spec.effects.keys() <= data.study.layout.effects.keys() for spec in runs.specs]
    )
    return diagnose_again(data, known, twins=0, added=0, options=OPTIONS).found


def test_the_cause_is_named_with_its_strength() -> None:
    found = _diagnosed()
    assert (found.verdict.kind, found.leading) == ("named", (STIFFNESS,))
    span = found.interval(STIFFNESS)
    assert span.low <= BEST <= span.high
    # It was 0.05 wide; one that holds the best strength because it holds many would say little.
    assert span.high - span.low < 0.08


def test_without_the_cause_in_the_library_it_is_unknown() -> None:
    with studies.without([STIFFNESS]):
        found = _diagnosed()
    assert found.verdict.kind == "unknown"
    assert STIFFNESS not in found.verdict.answers.single
    assert "What is unknown is most likely in oblique_impact of" in " ".join(sentences(found))
