"""Results in the forms that others read: LIGGGHTS lines, JSON, CSV."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any, Final

import numpy as np

from calibrate.questions.core.problem import unknown_at
from calibrate.questions.joint.result import JointResult
from calibrate.study.places import Place

__all__ = ["csv_text", "json_text", "liggghts_lines"]

PAIR_PROPERTIES: Final = {
    "restitution": ("coefficientRestitution", "e_pp", "e_pw"),
    "sliding": ("coefficientFriction", "mu_pp", "mu_pw"),
    "rolling": ("coefficientRollingFriction", "mu_roll_pp", "mu_roll_pw"),
}
"""Fix id to the property of LIGGGHTS 3.8.0 and the parameters between grains and at a wall."""
LEVEL: Final = 0.9


def liggghts_lines(result: JointResult, material: str) -> str:
    """Return lines for a LIGGGHTS script: material and contact properties of one material.

    Atom type 1 are the grains; every flat surface has the next type. What the data do not
    determine has a comment, since its number means nothing.

    Parameters
    ----------
    result : JointResult
    material : str
        Name of the material in the study.
    """
    study = result.study
    places = [place for place in study.places if place.material == material]
    flat = [
        name
        for name in dict.fromkeys(place.surface for place in places)
        if study.surface_named(name).kind == "flat"
    ]
    particle = study.material_named(material).bulk.particle
    types = ", ".join(f"{k} = {name}" for k, name in enumerate((material, *flat), 1))
    count = len(flat) + 1
    lines = [
        f"# {study.title}: {material}; values at the optimum, {LEVEL:.0%} intervals as comments",
        f"# atom types: {types}",
        _per_type("youngs", "youngsModulus", particle.youngs_modulus, count),
        _per_type("poisson", "poissonsRatio", particle.poisson_ratio, count),
    ]
    for fix, (word, grains, wall) in PAIR_PROPERTIES.items():
        used = [(grains, place) for place in places[:1]]
        used += [(wall, next(p for p in places if p.surface == name)) for name in flat]
        values = [_value(result, name, place) for name, place in used]
        lines += [_comment(result, name, place) for name, place in used]
        known = [value for value in values if value is not None]
        if len(known) < len(values):
            lines.append(f"# {word}: the study gives no value; left out")
            continue
        lines.append(
            f"fix {fix} all property/global {word} peratomtypepair {count} {_matrix(known)}"
        )
    return "\n".join(lines) + "\n"


def _per_type(fix: str, word: str, value: float, count: int) -> str:
    """Return the line of a property that grains and walls share, as in the experiments."""
    numbers = " ".join([f"{value:.6g}"] * count)
    return f"fix {fix} all property/global {word} peratomtype {numbers}"


def _matrix(values: list[float]) -> str:
    """Return the symmetric matrix over types; walls do not touch each other, any number will do."""
    count = len(values)
    return " ".join(f"{values[max(i, j)]:.6g}" for i in range(count) for j in range(count))


def _value(result: JointResult, name: str, place: Place) -> float | None:
    key = unknown_at(result.study, name, place)
    return result.study.value_of(name, *place) if key is None else result.best[key]


def _comment(result: JointResult, name: str, place: Place) -> str:
    """Return what is known of one number."""
    key = unknown_at(result.study, name, place)
    if key is None:
        return f"# {name}: given by the study"
    if key in result.undetermined:
        return f"# {key}: NOT DETERMINED by the data; the number is arbitrary within its range"
    span = result.posterior.interval(key, LEVEL)
    return f"# {key}: {result.best[key]:.4g} ({span.low:.4g} to {span.high:.4g})"


def json_text(result: JointResult) -> str:
    """Return everything that a program may want: values, intervals, draws, check, provenance."""
    posterior = result.posterior
    plain: dict[str, Any] = {
        "kind": "bulkcal joint calibration",
        "provenance": dict(result.provenance),
        "unknowns": result.table().reset_index().to_dict(orient="records"),
        "log_evidence": posterior.log_evidence,
        "log_evidence_error": posterior.log_evidence_error,
        "modes": [
            {
                "weight": one.weight,
                **{
                    what: dict(zip(posterior.names, getattr(one, what).tolist(), strict=True))
                    for what in ("low", "high", "mean")
                },
            }
            for one in posterior.regions
        ],
        "correlation": posterior.correlation().to_dict(),
        "check": result.check_table().to_dict(orient="records"),
        "unseen_z": result.unseen_z,
        "emulators": result.emulators.quality.to_dict(orient="records"),
        "sentences": list(result.sentences),
        "samples": {
            name: [float(f"{x:.6g}") for x in posterior.samples[:, k]]
            for k, name in enumerate(posterior.names)
        },
    }
    return json.dumps(_plain(plain), indent=1, allow_nan=False) + "\n"


def _plain(value: Any) -> Any:
    """Return a value as JSON holds it: no nan, no types of NumPy."""
    if isinstance(value, Mapping):
        return {str(key): _plain(one) for key, one in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(one) for one in value]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float) and not np.isfinite(value):
        return None
    return value


def csv_text(result: JointResult) -> str:
    """Return the table of unknowns as CSV."""
    return result.table().to_csv(lineterminator="\n")
