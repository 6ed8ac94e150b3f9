"""Experiments and effects of other packages: taken when they are right, named when they are not."""

import logging
from dataclasses import replace

import pytest

from liggghts_io import CaseError
from liggghts_io.effects import EFFECTS, Effect, effect_named
from liggghts_io.effects.from_table import tabled_effects
from liggghts_io.experiments import EXPERIMENTS, Experiment, experiment_named
from liggghts_io.experiments.bundled import bundled_experiments
from liggghts_io.plug_ins import load_plug_ins

GROUP = "bulkcal.experiments"
MODULE = """\
from dataclasses import replace
from liggghts_io.experiments.heap.experiment import HEAP
MOUND = replace(HEAP, name="mound")
TAKEN = HEAP
NUMBER = 7
"""
POINTS = """\
[bulkcal.experiments]
broken = theirs_that_is_not_there:X
good = theirs:MOUND
number = theirs:NUMBER
taken = theirs:TAKEN
"""


@pytest.fixture
def package(tmp_path, monkeypatch):
    """Install a package with one good and three broken experiments."""
    (tmp_path / "theirs.py").write_text(MODULE)
    info = tmp_path / "their_package-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: their-package\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(POINTS)
    monkeypatch.syspath_prepend(str(tmp_path))


def test_ours_come_through_the_same_door():
    assert set(EXPERIMENTS) >= {"heap", "conveyor", "plate_impact"}
    assert (
        load_plug_ins(GROUP, Experiment, bundled_experiments()).found.keys() == EXPERIMENTS.keys()
    )
    ours = load_plug_ins("bulkcal.effects", Effect, tabled_effects())
    assert list(ours.found) == list(EFFECTS)


@pytest.mark.usefixtures("package")
def test_a_broken_one_is_named_with_its_package_and_stops_nothing(caplog):
    with caplog.at_level(logging.WARNING):
        loaded = load_plug_ins(GROUP, Experiment, bundled_experiments())
    assert set(loaded.found) == {*EXPERIMENTS, "mound"}
    assert loaded.found["heap"] is EXPERIMENTS["heap"]
    for word, why in (
        ("broken", "cannot be loaded: ModuleNotFoundError"),
        ("number", "which is no Experiment"),
        ("taken", "whose name 'heap' is taken"),
    ):
        (said,) = (one for one in loaded.broken if repr(word) in one)
        assert said.startswith("the package their-package offers")
        assert why in said
        assert said in caplog.text


def test_an_unknown_name_tells_what_is_broken(monkeypatch):
    monkeypatch.setattr("liggghts_io.experiments._LOADED", _broken("experiments"))
    with pytest.raises(CaseError, match=r"unknown experiment 'mound'.*; the package x"):
        experiment_named("mound")
    monkeypatch.setattr("liggghts_io.effects._LOADED", _broken("effects"))
    with pytest.raises(CaseError, match=r"unknown effect 'wind'.*; the package x"):
        effect_named("wind")


def _broken(group):
    loaded = load_plug_ins(f"bulkcal.{group}", object)
    return loaded._replace(broken=["the package x offers y, which cannot be loaded"])


def test_an_experiment_of_another_package_is_one_of_ours_in_all_but_its_name():
    mound = replace(EXPERIMENTS["heap"], name="mound")
    assert mound.acting("glued") == EXPERIMENTS["heap"].acting("glued")
