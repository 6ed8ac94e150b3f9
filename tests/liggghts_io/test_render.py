"""Pictures: something is drawn, with and without VTK."""

import logging

import cv2
import numpy as np
import pytest

from liggghts_io import CaseError, chart_case, execute, render_case, write_case
from liggghts_io.pictures import render as render_module


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


def test_without_vtk_the_picture_is_flat_and_says_so_once(small_spec, root, monkeypatch, caplog):
    result = execute(small_spec(), root)
    monkeypatch.setattr(render_module, "_draw_in_child", lambda directory, target: False)
    with caplog.at_level(logging.WARNING):
        picture = render_case(result.path)
    assert [record.message for record in caplog.records] == [
        "VTK cannot draw here (no display, no software renderer): flat picture"
    ]
    assert colours(picture) > 50


@pytest.mark.parametrize("experiment", ["heap", "plate_impact"])
def test_chart_shows_the_measurement(small_spec, root, experiment):
    result = execute(small_spec(experiment), root)
    assert colours(chart_case(result.path)) > 20


def test_no_picture_of_what_did_not_run(make_spec, tmp_path):
    write_case(make_spec(), tmp_path)
    with pytest.raises(CaseError, match="run the case first"):
        render_case(tmp_path)
    with pytest.raises(CaseError, match="bulkcal run"):
        chart_case(tmp_path)
