"""What the posterior says of any observable at any place, measured there or not."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
import pandas as pd

from calibrate.arrays import Array
from calibrate.errors import CalibrationError, unknown_name
from calibrate.inference.posterior import Posterior
from calibrate.questions.core.emulate import Emulators, emulators_of
from calibrate.questions.core.forms import Emulated
from calibrate.questions.core.from_study import form_key
from calibrate.questions.core.problem import place_name, seen_at
from calibrate.questions.core.runs import Runs
from calibrate.scales import backward, scale_of
from calibrate.study.data import StudyData
from calibrate.study.model import Study
from calibrate.study.places import Place

__all__ = ["Predicted", "predict"]

LEVELS: Final = (0.05, 0.16, 0.5, 0.84, 0.95)


@dataclass(frozen=True)
class Predicted:
    """Expected value of an observable, or of a curve at its levels.

    Attributes
    ----------
    place, observable, unit : str
    levels : tuple of float
        Of a curve; empty for a number.
    samples : (n, L) float64
        Draws: posterior and emulator error, no scatter of single runs.
    """

    place: str
    observable: str
    unit: str
    levels: tuple[float, ...]
    samples: Array

    def table(self) -> pd.DataFrame:
        """Return mean and quantiles, a row per level."""
        quantiles = np.quantile(self.samples, LEVELS, axis=0).T
        names = [f"q{round(100 * level):02d}" for level in LEVELS]
        found = pd.DataFrame(quantiles, columns=names)
        found.insert(0, "mean", self.samples.mean(axis=0))
        found.insert(0, "level", list(self.levels) or [np.nan])
        return found


def predict(
    data: StudyData,
    emulators: Emulators,
    runs: Runs,
    posterior: Posterior,
    place: Place,
    observable: str,
) -> Predicted:
    """Return what the posterior says of an observable.

    Parameters
    ----------
    data : StudyData
    emulators : Emulators
        An observable that they do not have is learnt from the runs.
    runs : Runs
    posterior : Posterior
    place : Place
        Any combination of the study's materials and surfaces with an experiment that was run.
    observable : str
        Observable of the experiment, or a curve that was measured somewhere.

    Raises
    ------
    CalibrationError
        For unknown names, and for an experiment without runs.
    """
    study = data.study
    _check(study, place)
    key = form_key(study, place)
    if key not in emulators.trained:
        ran = ", ".join(f"{experiment} ({kind})" for experiment, kind in emulators.trained)
        msg = f"predict: the study has no runs of {place.experiment} ({key[1]}); it has {ran}"
        raise CalibrationError(msg)
    trained = emulators.trained[key]
    output = next((one for one in trained.form.outputs if one.name == observable), None)
    if output is None:
        experiment = study.experiments[place.experiment]
        scale = scale_of(experiment.observable(observable).unit)
        output = Emulated(observable, scale, slice(0, 1))
        form = replace(trained.form, outputs=(output,))
        trained = emulators_of({key: form}, runs).trained[key]
    seen = seen_at(study, posterior.space, place, trained.form, trained.emulator)
    expected = seen.predict(posterior.samples).columns(output.columns)
    rng = np.random.default_rng(study.run.seed)
    own = np.sqrt(expected.variance) * rng.normal(size=expected.mean.shape)
    shared = rng.normal(size=(len(expected.mean), 1, expected.factors.shape[2]))
    draws = expected.mean + own + np.sum(expected.factors * shared, axis=2)
    unit = _unit(study, place.experiment, observable)
    samples = backward(output.scale, draws)
    return Predicted(place_name(place), observable, unit, output.levels, samples)


def _check(study: Study, place: Place) -> None:
    """Refuse a place of which the study knows nothing."""
    for word, known in (
        (place.material, [one.name for one in study.materials]),
        (place.surface, [one.name for one in study.surfaces]),
        (place.experiment, list(study.experiments)),
    ):
        if word not in known:
            msg = f"predict: {unknown_name(word, known)}"
            raise CalibrationError(msg)


def _unit(study: Study, experiment: str, name: str) -> str:
    """Return the unit of an observable or a curve."""
    curves = {one.name: one.unit for one in study.experiments[experiment].curves}
    return curves[name] if name in curves else study.experiments[experiment].observable(name).unit
