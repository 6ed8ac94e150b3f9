"""Studies on formulas for the diagnosis: a whole bench, few unknowns, effects of any strength."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

from calibrate.causes.diagnosis import Options
from calibrate.causes.judging.levels import Levels
from calibrate.causes.weighing.evidences import Effort
from calibrate.questions.core.design import first_cases
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.runs import Runs, make_runs
from calibrate.runs.campaign import run_table
from calibrate.study.data import StudyData, load_data
from liggghts_io import CaseResult, CaseSpec
from liggghts_io.effects import EFFECTS
from tests.calibrate import stand_in
from tests.calibrate.questions.planted import bench, planted_study

GAINS = {
    "plate_tilt_deg": ("t100_s", -0.05),
    "plate_period": ("t100_s", 1.0),
    "mass_flow_factor": ("t100_s", -1.0),
    "cohesion_J_m3": ("angle_deg", 4e-6),
}
"""What a unit of an effect adds to an observable, as a part of it, compounded."""
PERIOD, TRUTH = "plate_period", 0.15
"""A plate that is slow, and by how much."""
LEVEL = "[known.plate_tilt_deg]\nse = 0.05\n"
SHEAR = "[known.mu_pp]\nvalue = 0.45\nse = 0.02\n[known.mu_pw]\nvalue = 0.3\nse = 0.01\n"
FASTER = 3.0
"""By what a wrong period matters more where the plate is set to another one."""
FREE = ("mu_pp", "mu_roll_pp", "mu_pw")
_WITHOUT = stand_in.simulate  # tests put `observed` in its place
FEW = Options(Levels(studies=200), held_out=False, effort=Effort(60.0, 2))


@contextmanager
def without(names: Iterable[str]) -> Iterator[None]:
    """Take effects out of the library; they come back in their order."""
    every = dict(EFFECTS)
    for name in names:
        del EFFECTS[name]
    try:
        yield
    finally:
        EFFECTS.clear()
        EFFECTS.update(every)


def factor(surface: str, observable: str, effects: Mapping[str, float]) -> float:
    """Return by what effects multiply an observable."""
    found = 1.0
    for name, strength in effects.items():
        touched, gain = GAINS.get(name, ("", 0.0))
        # Grains between glued ones feel a tilt less than loose ones do.
        share = 0.4 if surface == "glued" and name == "plate_tilt_deg" else 1.0
        if observable == touched:
            found *= math.exp(share * gain * strength)
    return found


def observed(spec: CaseSpec) -> dict[str, float]:
    """Return what the formulas give, with their noise, and what effects make of it.

    The noise of a case and of its effect twin is the same, as that of runs with a common seed.
    """
    plain = _WITHOUT(replace(spec, effects={}))
    effects = dict(spec.effects)
    if "period_s" in spec.apparatus:
        effects[PERIOD] = FASTER * effects.get(PERIOD, 0.0)
    return {name: value * factor(spec.surface, name, effects) for name, value in plain.items()}


def run(specs: Sequence[CaseSpec], _label: str) -> pd.DataFrame:
    """Run cases on the formulas; nothing is stored."""
    results = [
        CaseResult(stand_in.case_id(spec), Path(), "ok", "", observed(spec), 0.01) for spec in specs
    ]
    return run_table(specs, results)


def study(folder: Path, hidden: dict[str, float], seed: int, more: str = "") -> StudyData:
    """Return a study of one material on two plates whose bench had an effect that nobody knows.

    Parameters
    ----------
    folder : Path
    hidden : dict of str to float
        Effect and strength; may be empty.
    seed : int
        Of the errors of measurement.
    more : str
        Further tables of the study.
    """
    rng = np.random.default_rng(seed)
    data = planted_study(
        folder, [*bench("A", "steel"), *bench("A", "glued")], rng, free=FREE,
        design="runs = 150\ncheck_seeds = 2", more=more,
    )  # fmt: skip
    text = data.path.read_text(encoding="utf-8")
    for one in data.study.targets:
        given = one.value or 0.0
        changed = given * factor(one.surface, one.observable, hidden)
        text = text.replace(f"value = {given:.6f}", f"value = {changed:.6f}")
    data.path.write_text(text, encoding="utf-8")
    return load_data(data.path)


def base_runs(data: StudyData) -> Runs:
    """Return runs of a space-filling design, as a joint calibration begins."""
    forms = forms_of(data)
    specs = first_cases(data.study, forms, np.random.default_rng(1))
    return make_runs(specs, "", run, forms)
