"""Pictures: something is drawn, with and without VTK."""

import logging
from dataclasses import replace

import cv2
import numpy as np
import pytest

from liggghts_io import CaseError, chart_case, execute, render_case, write_case
from liggghts_io.case.spec import build_case
from liggghts_io.experiments import EXPERIMENTS
from liggghts_io.pictures import child


@pytest.fixture(scope="module")
def root(tmp_path_factory):
    return tmp_path_factory.mktemp("cases")


def colours(path):
    image = cv2.imread(str(path))
    assert image is not None
    return len(np.unique(image.reshape(-1, 3), axis=0))


def test_scene_is_drawn(small_spec, root):
    """With VTK where it can draw, flat elsewhere; a blank picture would have one colour."""
    result = execute(small_spec(), root)
    picture = render_case(result.path)
    assert picture == result.path / "scene.png"
    assert colours(picture) > 50
    assert not list(result.path.glob(".*.png"))


def test_without_vtk_grains_are_discs_without_a_warning(small_spec, root, monkeypatch, caplog):
    result = execute(small_spec(), root)
    monkeypatch.setattr(child, "_started", lambda: None)
    with caplog.at_level(logging.INFO):
        picture = render_case(result.path)
    assert [(record.levelname, record.message) for record in caplog.records] == [
        ("INFO", "VTK cannot draw here (no display, no software renderer): discs")
    ]
    assert colours(picture) > 50


@pytest.mark.parametrize("experiment", ["heap", "plate_impact"])
def test_chart_shows_the_measurement(small_spec, root, experiment):
    result = execute(small_spec(experiment), root)
    assert colours(chart_case(result.path)) > 20


@pytest.mark.parametrize("experiment", sorted(EXPERIMENTS))
def test_a_view_shows_meshes_that_the_experiment_builds(make_spec, experiment):
    build = build_case(make_spec(experiment))
    names = {*build.meshes, *(name.removesuffix(".stl") for name in build.stl)}
    assert EXPERIMENTS[experiment].view.solid.keys() <= names


def test_a_new_experiment_is_run_and_drawn_from_its_record_alone(small_spec, tmp_path, monkeypatch):
    """Its name stands in the registry and nowhere else; its chart and view are its own."""

    def chart(folder, setup, observables, axes):
        axes.bar([f"{name} of {setup.kind}" for name in observables], observables.values())
        axes.set_xlabel(folder.name)

    plain = EXPERIMENTS["heap"]
    view = replace(plain.view, solid={}, at=lambda _setup: 0.5)
    monkeypatch.setitem(EXPERIMENTS, "mound", replace(plain, name="mound", chart=chart, view=view))
    monkeypatch.setattr(child, "_started", lambda: None)
    result = execute(replace(small_spec(), experiment="mound"), tmp_path)
    assert result.status == "ok", result.reason
    assert colours(render_case(result.path)) > 50
    assert colours(chart_case(result.path)) > 5


def test_no_picture_of_what_did_not_run(make_spec, tmp_path):
    write_case(make_spec(), tmp_path)
    with pytest.raises(CaseError, match="has not been run; run it with 'bulkcal run"):
        render_case(tmp_path)
    with pytest.raises(CaseError, match="bulkcal run"):
        chart_case(tmp_path)
