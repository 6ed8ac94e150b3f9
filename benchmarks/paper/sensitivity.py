"""One parameter at a time around Table B.3, as the paper's Figs. B.11 to B.13.

From the emulators of the joint study, which need no further run, with their own error; and, where
the runs of `bulkcal sensitivity` are stored, from the engine itself, with Young's modulus and
Poisson's ratio.
"""

from __future__ import annotations

from dataclasses import dataclass

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from benchmarks.paper import sources
from benchmarks.paper.contours import SYMBOLS
from calibrate.emulator.types import Inputs
from calibrate.inference.problem import Place
from calibrate.questions.core.forms import Form
from calibrate.questions.core.problem import place_name
from calibrate.questions.joint.result import JointResult
from calibrate.questions.sensitivity.result import SensitivityResult
from calibrate.questions.sensitivity.study import Asked, plan_of, result_of
from calibrate.runs.campaign import run_table
from calibrate.scales import backward
from calibrate.study.places import Place as Where
from liggghts_io import case_id

STUDY = "hsp13_steel"
MATERIAL = "HSP13"
STEPS = 33
INK, LINE, MEASURED = "#4a4f57", "#2a7fb8", "#d1495b"
ROWS = (
    ("heap", "glued", "angle_deg"), ("heap", "steel", "angle_deg"),
    ("conveyor", "glued", "t100_s"), ("conveyor", "steel", "t100_s"),
    ("plate_impact", "steel", "m1_g"), ("plate_impact", "steel", "m2_g"),
    ("plate_impact", "steel", "m3_g"), ("plate_impact", "steel", "m4_g"),
)  # fmt: skip
ASKED = Asked()
"""What `bulkcal sensitivity` was asked for: one at a time with three seeds, and Sobol indices."""


@dataclass(frozen=True)
class Curve:
    """What one parameter does to one observable, all others at the baseline.

    Attributes
    ----------
    row : tuple of str
        Experiment, surface and observable.
    parameter : str
    x, y, sd : (n,) float64
        Values, expected observable and the emulator's error.
    baseline, measured, measured_se : float
    """

    row: tuple[str, str, str]
    parameter: str
    x: np.ndarray
    y: np.ndarray
    sd: np.ndarray
    baseline: float
    measured: float
    measured_se: float


def baseline() -> dict[str, float]:
    """Return the paper's baseline, Table B.3."""
    return sources.table("baseline").set_index("quantity")["value"].to_dict()


def curves(result: JointResult) -> list[Curve]:
    """Return all curves, from the emulators of a study with the material."""
    found, base = [], baseline()
    for row in ROWS:
        experiment, surface, _ = row
        where = Where(MATERIAL, surface, experiment)
        place = next(one for one in result.problem.places if one.name == place_name(where))
        kind = result.study.surface_named(surface).kind
        form = result.emulators.trained[experiment, kind].form
        for axis in form.axes:
            if axis.name in sources.CONTACT:
                found.append(_curve(result, place, form, row, axis.name, base))
    return found


def _inputs(result: JointResult, place: Place, form: Form, values: dict[str, float]) -> np.ndarray:
    """Return the emulator's inputs at values; dimensions of the apparatus have their priors' best.

    That is the default of the program, or the middle of the range.
    """
    found = []
    for axis, source in zip(form.axes, place.u, strict=True):
        if axis.name in values:
            number = values[axis.name]
        elif source.index is None:
            number = source.value
        else:
            experiment = place.name.split(" ")[0]
            rig = result.study.experiments[experiment].apparatus(result.study.run.scale, {})
            number = rig[axis.name.rpartition(".")[2]]
        found.append(float(axis.unit(np.array(number))))
    return np.array(found)


def _curve(
    result: JointResult, place: Place, form: Form, row: tuple[str, str, str], name: str,
    base: dict[str, float],
) -> Curve:  # fmt: skip
    axis = next(one for one in form.axes if one.name == name)
    x = np.linspace(axis.low, axis.high, STEPS)
    u = np.array([_inputs(result, place, form, base | {name: float(one)}) for one in x])
    target = next(
        t for t in result.study.targets
        if (t.material, t.surface, t.experiment, t.observable)
        == (MATERIAL, row[1], row[0], row[2])
    )  # fmt: skip
    reading = next(one for one in place.readings if one.name == target.name)
    from_emulator = place.emulator.predict(Inputs.at(np.clip(u, 0.0, 1.0))).columns(reading.columns)
    mean, sd = from_emulator.mean[:, 0], np.sqrt(from_emulator.total[:, 0])
    low, y, high = (backward(target.model_scale, one) for one in (mean - sd, mean, mean + sd))
    value = result.data.scalars[target.name]
    return Curve(row, name, x, y, 0.5 * (high - low), base[name], value.value, value.se)


def table(found: list[Curve]) -> pd.DataFrame:
    """Return a row per curve: its ends, how far it spans, and the emulator's error."""
    return pd.DataFrame([
        {
            "experiment": one.row[0], "surface": one.row[1], "observable": one.row[2],
            "parameter": one.parameter, "low": one.x[0], "high": one.x[-1],
            "at_low": one.y[0], "at_high": one.y[-1], "span": one.y.max() - one.y.min(),
            "sd": float(np.median(one.sd)),
        }
        for one in found
    ])  # fmt: skip


def figure(found: list[Curve]) -> Figure:
    """Return the curves: a row per observable, a column per parameter."""
    with mpl.rc_context({"font.size": 9}):
        drawn = Figure(figsize=(11.0, 13.0), layout="constrained")
        axes = drawn.subplots(len(ROWS), len(sources.CONTACT), sharey="row", sharex="col")
        for one in axes.ravel():
            one.set_visible(False)
        for one in found:
            _draw(axes[ROWS.index(one.row), sources.CONTACT.index(one.parameter)], one)
        for row, (experiment, surface, observable) in enumerate(ROWS):
            axes[row, 0].set_ylabel(f"{experiment}, {surface}\n{observable}", color=INK)
        for column, name in enumerate(sources.CONTACT):
            axes[-1, column].set_xlabel(SYMBOLS[name], fontsize=12)
    return drawn


def _draw(axes: Axes, one: Curve) -> None:
    axes.set_visible(True)
    axes.fill_between(one.x, one.y - one.sd, one.y + one.sd, color=LINE, alpha=0.25, linewidth=0)
    axes.plot(one.x, one.y, color=LINE, linewidth=1.6)
    axes.axvline(one.baseline, color=INK, linestyle=":", linewidth=0.9)
    axes.axhspan(one.measured - one.measured_se, one.measured + one.measured_se,
                 color=MEASURED, alpha=0.5, linewidth=0.8)  # fmt: skip
    axes.tick_params(labelsize=8, labelbottom=True)


def from_engine() -> SensitivityResult | None:
    """Return what runs one parameter at a time say; None where not all of them are stored."""
    rows = {case_id(row.spec): row.result for row in sources.rows(sources.SENSITIVITY)}
    plan = plan_of(sources.study(STUDY), ASKED)
    ids = [case_id(spec) for spec in plan.specs]
    if not set(ids) <= rows.keys():
        return None
    results = [rows[one] for one in ids]
    return result_of(plan, run_table(plan.specs, results))


def draw(result: JointResult) -> None:
    """Draw the curves and store what they say."""
    found = curves(result)
    sources.keep(table(found), "sensitivity")
    sources.save(figure(found), sources.IMAGES / "paper_sensitivity.png", 85)


def draw_engine() -> None:
    """Draw what runs of the engine say and store it, where all of them are stored."""
    engine = from_engine()
    if engine is not None:
        sources.keep(engine.table(), "sensitivity_engine")
        sources.save(engine.figure(), sources.IMAGES / "paper_sensitivity_engine.png", 110)
        sources.save(engine.indices_figure(), sources.IMAGES / "paper_sobol.png", 110)
