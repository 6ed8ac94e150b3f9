"""`bulkcal apparatus`: everything that can be changed, whole also in a pipe."""

from __future__ import annotations

import json
from functools import partial

import pytest
from rich.console import Console

from calibrate.cli import apparatus
from calibrate.cli.show import output
from liggghts_io.effects import EFFECTS
from liggghts_io.experiments import EXPERIMENTS


@pytest.mark.parametrize("name", EXPERIMENTS)
def test_every_parameter_stands_there_with_unit_meaning_and_values(name: str, bulkcal):
    code, out, _ = bulkcal("apparatus", name)
    assert code == 0
    assert "…" not in out
    lines = out.splitlines()
    for one in EXPERIMENTS[name].parameters:
        line = next(line for line in lines if line.startswith(f"│ {one.name} "))
        values = (one.quick, one.lab, one.paper, *one.limits)
        for word in (one.unit, one.meaning, *(f"{v:g}" for v in values if v < float("inf"))):
            assert word in line
    for observable in EXPERIMENTS[name].observables:
        line = next(line for line in lines if line.startswith(f"│ {observable.name} "))
        assert observable.unit in line
        assert observable.meaning in line
    for effect in EFFECTS.values():
        assert (f"│ {effect.name} " in out) == effect.acts_in(name)


def test_the_same_as_json(bulkcal):
    found = json.loads(bulkcal("apparatus", "heap", "--json")[1])
    by_name = {row["name"]: row for row in found["parameters"]}
    assert by_name["slice_width_d"]["unit"] == "d"
    assert by_name["slice_width_d"]["lowest"] > 0.0
    assert (by_name["slice_width_d"]["quick"], by_name["slice_width_d"]["paper"]) == (3.0, 120.0)


def test_an_unknown_experiment_is_named(bulkcal):
    code, _, err = bulkcal("apparatus", "heep")
    assert code == 2
    assert "did you mean 'heap'?" in err


@pytest.mark.parametrize("name", EXPERIMENTS)
def test_names_and_numbers_are_whole_in_a_narrow_window(name: str, bulkcal, monkeypatch):
    """Eighty columns, as a terminal opens: limits and sources go, no name is folded."""
    narrow = partial(Console, width=80)
    monkeypatch.setattr(apparatus, "stdout", narrow)
    monkeypatch.setattr(output, "stdout", narrow)
    code, out, _ = bulkcal("apparatus", name)
    assert code == 0
    lines = [line for line in out.splitlines() if line.startswith("│")]
    for one in EXPERIMENTS[name].parameters:
        line = next(line for line in lines if line.startswith(f"│ {one.name} "))
        for value in (one.quick, one.lab, one.paper):
            assert f" {value:g} " in line
    assert "limits and sources are shown from 140 columns on" in out
