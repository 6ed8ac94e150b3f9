"""Means in cells and their VTK files, held against what LIGGGHTS writes."""

from __future__ import annotations

import numpy as np
import pytest

from minidem import run_script
from minidem.errors import ScriptError
from minidem.insertion.seeds import ParkMiller
from tests.minidem.output import scenes

LINES = """region hh cylinder z 0.0 0.0 0.04 -0.1 0.2 units box
group odd type 1
fix eu odd ave/euler nevery 5 cell_size_relative 7.5 parallel yes basevolume_region hh
dump e all euler/vtk 50 e*.vtk
run 100
set atom 1 diameter 0.012
run 60
"""


def test_cells_are_those_of_liggghts(tmp_path):
    found = scenes.run_minidem(tmp_path, scenes.scene(LINES))
    assert sorted(found) == ["e0.vtk", "e100.vtk", "e150.vtk", "e50.vtk"]
    assert scenes.alike(found["e150.vtk"], (scenes.STORED / "euler_e150.vtk").read_text())


@pytest.mark.liggghts
def test_all_files_are_those_of_liggghts(tmp_path):
    for name, old, new in (
        ("region", "", ""),
        ("whole box", " basevolume_region hh", ""),
        (
            "far contacts",
            "neigh_modify delay 0",
            "neigh_modify delay 0 contact_distance_factor 1.1",
        ),
    ):
        script = scenes.scene(LINES).replace(old, new)
        mine = scenes.run_minidem(tmp_path / name / "mine", script)
        theirs = scenes.run_liggghts(tmp_path / name / "theirs", script)
        assert not scenes.different(mine, theirs), name


def test_random_numbers_at_once_are_those_one_by_one():
    one, many = ParkMiller(15485863), ParkMiller(15485863)
    np.testing.assert_array_equal(many.uniforms(1000), [one.uniform() for _ in range(1000)])
    assert many.uniform() == one.uniform()
    assert len(many.uniforms(0)) == 0


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("fix a all ave/euler nevery 5", "cell_size_relative C parallel yes"),
        ("fix a all ave/euler nevery 5 cell_size_relative 0.5 parallel no", "0.5 is below 1"),
        ("fix a all ave/euler nevery 0 cell_size_relative 3 parallel no", "not positive"),
        ("fix a all ave/euler every 5 cell_size_relative 3 parallel no", "expected 'nevery'"),
        (
            "fix a all ave/euler nevery 5 cell_size_relative 3 parallel no basevolume_region q",
            "unknown region 'q'",
        ),
        ("dump a all euler/vtk 5 a.vtk", "needs a * for the step"),
        ("dump a all euler/vtk 5 a*.vtk\nrun 1", "needs a fix ave/euler"),
    ],
)
def test_mistake_names_file_and_line(tmp_path, line, message):
    script = scenes.write(tmp_path, scenes.scene(line + "\n"))
    with pytest.raises(ScriptError) as error:
        run_script(script, root=tmp_path)
    assert message in str(error.value)
