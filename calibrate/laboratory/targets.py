"""The lines of a study that read a measured number or curve, checked before they are written."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from pydantic import ValidationError

from calibrate.errors import CalibrationError
from calibrate.laboratory.entries import SE, VALUE, Entry
from calibrate.study.measured.scalars import given_value
from calibrate.study.schema.targets import Target
from calibrate.study.writing.toml import document
from liggghts_io.errors import told
from liggghts_io.experiments import EXPERIMENTS, Experiment

__all__ = ["Place", "check_value", "curve_lines", "experiment_lines", "value_lines"]

_OPTIONS: Final = {
    "name": "--name", "label": "--name", "material": "--material", "surface": "--surface",
    "experiment": "--experiment", "observable": "--observable", "unit": "--unit",
}  # fmt: skip
"""Key of a target to the option of the command that gives it."""
_ANY: Final = "any"
"""Stands for a material or surface that is left to the study."""


@dataclass(frozen=True)
class Place:
    """Which simulated number or curve answers to what was measured.

    Attributes
    ----------
    experiment : Experiment
    observable : str
    """

    experiment: Experiment
    observable: str


def check_value(entry: Entry, place: Place) -> None:
    """Refuse a measured number that a study would refuse.

    Raises
    ------
    CalibrationError
        With option, value and remedy.
    """
    found = _target(entry.target, entry.material, entry.surface, place) | {
        "unit": entry.unit,
        "value": entry.value,
        "se": entry.se,
    }
    given_value(_checked(found, place), "")


def value_lines(entry: Entry, place: Place, file: str) -> str:
    """Return the lines of a target that reads an entry of a table."""
    found = {
        **_target(entry.target, entry.material, entry.surface, place),
        "unit": entry.unit,
        "file": file,
        "column": VALUE,
        "se_column": SE,
    }
    return _text({"target": [found]})


def curve_lines(
    name: str, material: str, surface: str, place: Place, table: Mapping[str, Any]
) -> str:
    """Return the lines of a target that reads a curve, and refuse what a study would refuse.

    Parameters
    ----------
    name, material, surface : str
    place : Place
    table : mapping
        Keys of the target that name file and columns.

    Raises
    ------
    CalibrationError
    """
    found = _target(name, material, surface, place) | dict(table)
    _checked(found, place)
    return _text({"target": [found]})


def experiment_lines(name: str, apparatus: Mapping[str, float]) -> str:
    """Return the lines that change the apparatus of an experiment."""
    return _text({"experiment": [{"name": name, "apparatus": dict(apparatus)}]})


def _text(tables: Mapping[str, Any]) -> str:
    return document(tables).strip()


def _target(name: str, material: str, surface: str, place: Place) -> dict[str, Any]:
    """Return what every target says; material and surface where they are given."""
    where = {"material": material, "surface": surface}
    return {
        "name": name,
        **{key: word for key, word in where.items() if word},
        "experiment": place.experiment.name,
        "observable": place.observable,
    }


def _checked(found: Mapping[str, Any], place: Place) -> Target:
    """Return the target of a study that says so."""
    known = {**EXPERIMENTS, place.experiment.name: place.experiment}
    try:
        return Target.model_validate(
            {"material": _ANY, "surface": _ANY, **found}, context={"experiments": known}
        )
    except ValidationError as err:
        first = err.errors()[0]
        key = str(first["loc"][0]) if first["loc"] else ""
        place_of = f"{_OPTIONS[key]} {found.get(key, '')}: " if key in _OPTIONS else ""
        msg = f"{place_of}{told(first)}"
        raise CalibrationError(msg) from err
