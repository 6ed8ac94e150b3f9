"""One dialect: every record documents its fields under Attributes."""

from __future__ import annotations

import dataclasses
import importlib
import inspect
import pkgutil
import re

import pytest
from pydantic import BaseModel

PACKAGES = ("calibrate", "liggghts_io", "minidem")


def records() -> dict[str, type]:
    """Return the public dataclasses, models and named tuples of the packages by full name."""
    found = {}
    for package in PACKAGES:
        home = importlib.import_module(package).__path__
        for module in pkgutil.walk_packages(home, f"{package}."):
            loaded = importlib.import_module(module.name)
            for name, one in inspect.getmembers(loaded, inspect.isclass):
                if one.__module__ == module.name and name[0] != "_" and fields_of(one):
                    found[f"{module.name}.{name}"] = one
    return found


def fields_of(one: type) -> list[str]:
    """Return the public fields that a record adds to its bases, none for another class."""
    if dataclasses.is_dataclass(one):
        names = [field.name for field in dataclasses.fields(one)]
    elif issubclass(one, BaseModel):
        names = list(one.model_fields)
    else:
        names = list(getattr(one, "_fields", ()))
    own = inspect.get_annotations(one)
    return [name for name in names if name in own and not name.startswith("_")]


RECORDS = records()


def documented(text: str) -> set[str]:
    """Return the names that stand under Attributes."""
    section = text.partition("Attributes\n----------\n")[2]
    section = re.split(r"\n\n?[A-Z]\w+\n-----", section)[0]
    heads = [line for line in section.splitlines() if re.match(r"\w+(, \w+)* : ", line)]
    return {name for line in heads for name in line.partition(" : ")[0].split(", ")}


def test_there_are_records() -> None:
    assert "calibrate.study.model.Study" in RECORDS
    assert len(RECORDS) > 40


@pytest.mark.parametrize("name", RECORDS)
def test_every_field_of_a_record_stands_under_attributes(name: str) -> None:
    text = inspect.getdoc(RECORDS[name]) or ""
    assert "Parameters\n---" not in text
    assert documented(text) == set(fields_of(RECORDS[name]))
