"""Held-out test: the apparatus from one material at published parameters, the others predicted.

Dimensions that the paper does not print are inferred from HSP13 alone, whose contact parameters are
held at the paper's, with the emulators of its own study. With them, and the paper's parameters of
the other four, everything else that was measured is predicted by the emulators of the joint study;
no measured value of the four is used, and nothing more is run.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pandas as pd

from benchmarks.paper import sources
from calibrate.errors import CalibrationError
from calibrate.inference.discrepancy import with_discrepancy
from calibrate.inference.posterior import Posterior
from calibrate.inference.problem import Place, Problem, Source
from calibrate.inference.sampling import sample
from calibrate.inference.space import Space
from calibrate.questions.core.problem import place_name
from calibrate.questions.joint.result import JointResult
from calibrate.scales import backward, slope
from calibrate.study.places import Place as Where

LEARNT = "HSP13"


def published(material: str, surface: str) -> tuple[dict[str, float], str]:
    """Return the paper's parameters of a material on a surface, and its flag.

    On a glued plate those of steel, of which only the ones between grains matter. Wall restitution
    on alumina was found for HSP13 alone, and is taken for all, as the paper does.
    """
    table = sources.table("calibrated_parameters").set_index(["particle", "surface"])
    names = {ours: theirs for theirs, ours in sources.MATERIALS.items()}
    row = table.loc[names[material], "steel" if surface == "glued" else surface]
    steel = table.loc[names[material], "steel"]
    first = table.loc[names[LEARNT], "steel" if surface == "glued" else surface]
    values = {name: row[name] for name in sources.CONTACT}
    values["e_pp"] = row["e_pp"] if pd.notna(row["e_pp"]) else steel["e_pp"]
    values["e_pw"] = row["e_pw"] if pd.notna(row["e_pw"]) else first["e_pw"]
    flag = "" if surface == "glued" or pd.isna(row["flag"]) else str(row["flag"])
    return {name: float(value) for name, value in values.items()}, flag


def _rig(result: JointResult) -> tuple[Space, list[int]]:
    """Return the unknowns of the apparatus alone, and their columns in the joint study."""
    study, space = result.study, result.problem.space
    names = {name for name, _ in study.free if study.layout.role(name) == "apparatus"}
    columns = [k for k, one in enumerate(space.unknowns) if one.name in names]
    return Space(tuple(space.unknowns[k] for k in columns)), columns


def _held(result: JointResult, where: Where, columns: list[int]) -> Place:
    """Return a place whose contact parameters are the published ones."""
    form = result.emulators.trained[
        where.experiment, result.study.surface_named(where.surface).kind
    ].form
    seen = next(p for p in result.problem.places if p.name == place_name(where))
    values, _ = published(where.material, where.surface)
    sources_ = []
    for axis, source in zip(form.axes, seen.u, strict=True):
        if axis.name in values:
            held = float(np.clip(values[axis.name], axis.low, axis.high))
            sources_.append(Source(None, held, source.low, source.high, source.spacing))
        else:
            index = None if source.index is None else columns.index(source.index)
            sources_.append(replace(source, index=index))
    readings = tuple(replace(one, shared=(), discrepancy=None) for one in seen.readings)
    return replace(seen, u=tuple(sources_), readings=readings)


def apparatus(result: JointResult) -> Posterior:
    """Return what HSP13 at its published parameters says of the apparatus."""
    space, columns = _rig(result)
    places = [p for p in result.study.places if p.material == LEARNT]
    problem = Problem(space, tuple(_held(result, one, columns) for one in places))
    rng = np.random.default_rng(result.study.run.seed)
    problem = with_discrepancy(problem, result.study.likelihood.discrepancy, rng)
    return sample(problem, rng)


def predicted(result: JointResult, rig: Posterior) -> pd.DataFrame:
    """Return every target as measured and as predicted with the apparatus that HSP13 gave.

    ``predicted_sd`` holds the uncertain apparatus, the emulator's error and the shared errors of
    the study (coarse grains); ``z`` counts standard errors of both.
    """
    space, columns = _rig(result)
    if space.names != rig.names:
        msg = f"{result.study.name}: other dimensions are free than were inferred"
        raise CalibrationError(msg)
    shared = {name: one.relative_se or 0.0 for one in result.study.shared for name in one.targets}
    found = []
    for where in result.study.places:
        place = _held(result, where, columns)
        for reading in place.readings:
            target = result.study.target_named(reading.name)
            expected = place.predict(rig.samples).columns(reading.columns)
            mean = float(expected.mean[:, 0].mean())
            value = float(backward(target.model_scale, np.array(mean)))
            step = slope(target.model_scale, value)
            spread = np.sqrt(expected.mean[:, 0].var() + expected.total[:, 0].mean()) / step
            spread = float(np.hypot(spread, shared.get(reading.name, 0.0) * value))
            measured = float(backward(target.model_scale, reading.y)[0])
            se = float(reading.se[0]) / slope(target.model_scale, measured)
            found.append({
                "name": reading.name, "material": where.material, "surface": where.surface,
                "experiment": where.experiment, "observable": target.observable,
                "learnt": where.material == LEARNT,
                "flag": published(where.material, where.surface)[1],
                "measured": measured, "measured_se": se, "predicted": value,
                "predicted_sd": spread, "z": (value - measured) / float(np.hypot(se, spread)),
            })  # fmt: skip
    return pd.DataFrame(found)


def rig_table(rig: Posterior) -> pd.DataFrame:
    """Return the inferred apparatus: median and 90 % interval."""
    table = rig.table().reset_index()
    return pd.DataFrame({
        "name": table["name"], "median": np.median(rig.samples, axis=0),
        "low_90": table["low_90"], "high_90": table["high_90"],
    })  # fmt: skip
