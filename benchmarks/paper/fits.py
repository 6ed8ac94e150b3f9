"""What the stored runs say: parameters, and every target as the fit has it."""

from __future__ import annotations

import numpy as np
import pandas as pd

from benchmarks.paper import sources
from calibrate.errors import CalibrationError
from calibrate.questions.core.design import stands_of
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.joint.knowledge import fit_jointly
from calibrate.questions.joint.result import JointResult

STUDIES = ("hsp13", "proppants")
LEAST_RUNS = 5
"""Of a particle in each experiment and kind of surface."""


def shown() -> list[str]:
    """Return the studies of which results are stored."""
    return [name for name in STUDIES if not sources.result(f"targets_{name}").empty]


def fitted(name: str) -> JointResult:
    """Fit a study to the stored runs.

    Raises
    ------
    CalibrationError
        Where a particle has so few runs that its numbers would be those of the others.
    """
    data = sources.study(name)
    runs = sources.runs_for(data)
    for stand in stands_of(data.study, forms_of(data)):
        grains = data.study.material_named(stand.material).bulk.name
        mine = np.array([spec.particle.name == grains for spec in runs.specs])
        count = int((runs.of(stand.form.key) & mine).sum())
        if count < LEAST_RUNS:
            where = f"{stand.material}, {' on '.join(stand.form.key)}"
            msg = f"{count} stored runs of {where}; a fit is made from {LEAST_RUNS} of each"
            raise CalibrationError(msg)
    return fit_jointly(data, runs)


def parameters(result: JointResult) -> pd.DataFrame:
    """Return a row per unknown: most probable value, median, 90 % interval, whether determined."""
    table = result.table().reset_index()
    median = np.median(result.posterior.samples, axis=0)
    by_name = dict(zip(result.posterior.names, median, strict=True))
    return pd.DataFrame({
        "name": table["name"],
        "best": table["best"],
        "median": [by_name[name] for name in table["name"]],
        "low_90": table["low_90"],
        "high_90": table["high_90"],
        "determined": table["determined"],
    })  # fmt: skip


def targets(result: JointResult) -> pd.DataFrame:
    """Return a row per target: measured, what the posterior expects, how far they are apart.

    ``z`` counts standard errors of measurement and expectation together. ``engine`` is the mean of
    runs at the very optimum, where there are some.
    """
    found = []
    for row in result.check:
        error = float(np.hypot(row.measured_se, row.predicted_sd))
        found.append({
            "name": row.name, "measured": row.measured, "measured_se": row.measured_se,
            "predicted": row.predicted, "predicted_sd": row.predicted_sd,
            "z": (row.predicted - row.measured) / error, "discrepancy": row.discrepancy,
            "engine": row.simulated, "seeds": row.seeds, "error_ratio": row.error_ratio,
        })  # fmt: skip
    return pd.DataFrame(found)


def quality(result: JointResult) -> pd.DataFrame:
    """Return how well the emulators know runs that they have not seen."""
    return result.emulators.quality


def campaign(name: str) -> pd.DataFrame:
    """Return a row per experiment and particle: runs, failures, particle-steps, time on the clock.

    Parameters
    ----------
    name : str
        "quick" or "sensitivity", the table of runs.
    """
    path = sources.RUNS if name == "quick" else sources.SENSITIVITY
    found = [
        {
            "particle": row.spec.particle.name,
            "experiment": row.spec.experiment,
            "surface": row.spec.surface,
            "runs": 1,
            "failed": int(row.result.status != "ok"),
            "particle_steps": float(row.facts["steps"]) * float(row.facts["grains"]),
            "wall_s": row.result.wall_s,
        }
        for row in sources.rows(path)
    ]
    keys = ["particle", "experiment", "surface"]
    if not found:
        return pd.DataFrame(columns=[*keys, "runs", "failed", "particle_steps", "wall_s"])
    return pd.DataFrame(found).groupby(keys, sort=False).sum().reset_index()
