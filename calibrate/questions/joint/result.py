"""What a joint calibration found."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from calibrate.inference.posterior import Posterior
from calibrate.inference.problem import Problem
from calibrate.questions.core.emulate import Emulators
from calibrate.questions.core.runs import Runs
from calibrate.questions.figures import corner_figure
from calibrate.questions.joint.check import CheckRow
from calibrate.questions.predict import Predicted, predict
from calibrate.study.data import StudyData
from calibrate.study.model import Study
from calibrate.study.places import Place

__all__ = ["JointResult"]


@dataclass(frozen=True, repr=False)
class JointResult:
    """Result of a joint calibration.

    Attributes
    ----------
    data : StudyData
        The study and what was measured.
    problem : Problem
        Unknowns, emulators and readings.
    emulators : Emulators
    posterior : Posterior
    best : mapping
        Value of every unknown at the optimum, with which the engine was run.
    undetermined : tuple of str
        Unknowns that the data do not determine; their values mean nothing.
    check : tuple of CheckRow
        Measured, simulated and predicted, one row per target.
    unseen_z : float
        Root mean square distance of the check's runs from what the emulators had expected before
        they saw them, in expected errors; 1 is honest.
    sentences : tuple of str
        What a reader should know.
    runs : Runs
        All runs behind the emulators.
    provenance : mapping
        Study, digest, versions, numbers of runs.
    """

    data: StudyData
    problem: Problem
    emulators: Emulators
    posterior: Posterior
    best: Mapping[str, float]
    undetermined: tuple[str, ...]
    check: tuple[CheckRow, ...]
    unseen_z: float
    sentences: tuple[str, ...]
    runs: Runs
    provenance: Mapping[str, Any]

    def __repr__(self) -> str:
        """Return one line; the tables have the rest."""
        return (
            f"JointResult({self.study.title!r}: {len(self.best) - len(self.undetermined)} of "
            f"{len(self.best)} unknowns determined, {len(self.runs)} runs; see .table(), "
            ".check_table(), .sentences, .figure())"
        )

    @property
    def study(self) -> Study:
        """The study itself."""
        return self.data.study

    @property
    def checked(self) -> bool:
        """Whether the engine was run at the values; a fit to stored runs asks for none."""
        return bool(self.provenance["runs_of_budget"])

    def table(self) -> pd.DataFrame:
        """Return a row per unknown: value, intervals, whether it is determined, published value."""
        found = self.posterior.table().copy()
        found["best"] = [self.best[name] for name in found.index]
        found.insert(1, "determined", [name not in self.undetermined for name in found.index])
        published = {
            key: self.study.published_of(name, instance)
            for (name, instance), key in zip(
                self.study.free, self.problem.space.names, strict=False
            )
        }
        found["published"] = [published.get(name) for name in found.index]
        return found

    def check_table(self) -> pd.DataFrame:
        """Return the final check as a table."""
        return pd.DataFrame([asdict(row) for row in self.check])

    def figure(self) -> Figure:
        """Return the corner plot."""
        return corner_figure(self.posterior, self.best, self.undetermined)

    def predict(
        self, experiment: str, observable: str, material: str = "", surface: str = ""
    ) -> Predicted:
        """Return what the posterior says of an observable, measured or not.

        Parameters
        ----------
        experiment, observable : str
        material, surface : str
            May be left out where the study has one only.

        Raises
        ------
        CalibrationError
            For unknown names, and for experiments of which the study has no runs.
        """
        place = Place(
            material or self.study.materials[0].name,
            surface or self.study.surfaces[0].name,
            experiment,
        )
        return predict(self.data, self.emulators, self.runs, self.posterior, place, observable)
