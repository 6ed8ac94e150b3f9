"""What the diagnosis of a study found, with what the engine says of it."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from calibrate.causes.diagnosis import Diagnosis
from calibrate.causes.studies.verify import EngineSays
from calibrate.causes.studies.words import study_sentences
from calibrate.causes.told.figure import diagnosis_figure
from calibrate.causes.told.record import diagnosis_record
from calibrate.questions.core.runs import Runs
from calibrate.questions.joint.check import CheckRow
from calibrate.study.data import StudyData

__all__ = ["StudyDiagnosis"]


@dataclass(frozen=True, eq=False, repr=False)
class StudyDiagnosis:
    """Result of `calibrate.causes.studies.study_diagnosis.diagnose_runs`.

    Attributes
    ----------
    data : StudyData
        The study and what was measured.
    found : Diagnosis
        Probabilities, verdict, visibility, residuals and gain.
    engine_before : tuple of CheckRow
        Every target, measured and simulated by the engine with fresh seeds, at the best values of
        the base model.
    engine_with : EngineSays
        The same with the best named cause; empty without one.
    runs : Runs
        All runs behind the emulators.
    twins : int
        How many of them repeat a run of the calibration with an effect on.
    added : int
        How many of them were added where evidence or strength hung on the emulators.
    unseen : tuple of str
        Effects that got few twins, because the data could not show them.
    further : int
        Runs of further experiments; nothing has learnt from them but what to measure next.
    """

    data: StudyData
    found: Diagnosis
    engine_before: tuple[CheckRow, ...]
    engine_with: EngineSays
    runs: Runs
    twins: int
    added: int
    unseen: tuple[str, ...]
    further: int = 0

    def __repr__(self) -> str:
        """Return one line; the tables have the rest."""
        verdict = self.found.verdict
        names = f" ({', '.join(verdict.names)})" if verdict.names else ""
        return (
            f"StudyDiagnosis({self.data.study.title!r}: {verdict.kind}{names}, {len(self.runs)} "
            "runs; see .sentences, .table(), .figure())"
        )

    @property
    def sentences(self) -> list[str]:
        """What a reader should know, the verdict first."""
        return study_sentences(self.found, self.engine_before, self.engine_with)

    def table(self) -> pd.DataFrame:
        """Return a row for every candidate, see `calibrate.causes.diagnosis.Diagnosis.table`."""
        return self.found.table()

    def figure(self) -> Figure:
        """Return residuals, strengths and probabilities in one picture."""
        return diagnosis_figure(self.record())

    def record(self) -> dict[str, Any]:
        """Return everything as plain data; numbers may be infinite or nan."""
        return {
            "study": self.data.study.name,
            "study_sha256": self.data.sha256,
            **diagnosis_record(self.found),
            "headline": self.sentences[0],
            "sentences": self.sentences,
            "supposed": [],  # what was not measured in truth: see --with
            "engine_before": [_row(one) for one in self.engine_before],
            "engine_after": [_row(one) for one in self.engine_with.rows],
            "engine_off": self.engine_with.off,
            "runs": list(self.runs.table["case_id"]),
            "twins": self.twins,
            "added": self.added,
            "few_twins": list(self.unseen),
            "further_runs": self.further,
            "failed_runs": int((self.runs.table["status"] != "ok").sum()),
        }


def _row(one: CheckRow) -> dict[str, Any]:
    """Return a target's row with z as everywhere in a diagnosis: measured minus simulated."""
    return asdict(replace(one, z=-one.z))
