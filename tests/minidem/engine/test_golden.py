"""Trajectories of LIGGGHTS 3.8.0 that minidem must reproduce digit by digit."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import numpy as np
import pytest

from minidem import run_script
from tests.minidem.loops import general_loops, own_loops
from tests.paths import DATA, ROOT

FOLDERS = [DATA / "golden", ROOT.parent / "shared" / "golden"]

RTOL = 1e-10
"""Of the largest value of a quantity in a case.

Both programs round differently where sums have another order; contacts amplify that, in most cases
to no more than 1e-14.
"""

NOT_YET: dict[str, str] = {}
"""Case to the command that is missing."""

RARE = re.compile(
    r"^pair_style .*(hooke|cohesion|cdt|rolling_friction epsd\b|limitForce)", re.MULTILINE
)
"""Models that one or two cases have; they run on the loop of all models, the others on their own
too, which takes the compiler half a minute each."""

QUANTITIES = {
    "position": slice(3, 6),
    "velocity": slice(6, 9),
    "force": slice(9, 12),
    "spin": slice(12, 15),
    "torque": slice(15, 18),
}


def cases():
    found = [case for folder in FOLDERS if folder.is_dir() for case in sorted(folder.iterdir())]
    for case in found:
        if (case / "in.case").is_file():
            reason = NOT_YET.get(case.name)
            marks = [pytest.mark.xfail(strict=True, reason=reason)] if reason else []
            place = "inner" if case.is_relative_to(ROOT) else "outer"
            yield pytest.param(case, id=f"{place}-{case.name}", marks=marks)


def read_dump(path: Path) -> np.ndarray:
    """Return the rows of a custom dump with the step in front."""
    rows = []
    lines = path.read_text().splitlines()
    at = 0
    while at < len(lines):
        step, count = lines[at + 1], int(lines[at + 3])
        rows += [[float(word) for word in (step, *row.split())] for row in lines[at + 9 :][:count]]
        at += 9 + count
    return np.array(rows)


def trajectory(case: Path, folder: Path) -> Path:
    """Run a case in a folder and return its dump."""
    folder.mkdir()
    for file in case.iterdir():
        if file.suffix in (".stl", ".data") or file.name == "in.case":
            shutil.copy(file, folder)
    run_script(folder / "in.case", root=folder)
    return folder / "traj.dump"


@pytest.mark.slow
@pytest.mark.parametrize("case", list(cases()))
def test_trajectory_is_that_of_liggghts(case, tmp_path):
    with general_loops():
        dump = trajectory(case, tmp_path / "general")
    if not RARE.search((case / "in.case").read_text()):
        with own_loops():
            own = trajectory(case, tmp_path / "own")
        assert own.read_bytes() == dump.read_bytes(), "the two loops differ"
    wanted = np.genfromtxt(case / "ref.csv", delimiter=",", skip_header=1)
    found = read_dump(dump)
    found = found[np.isin(found[:, 0], wanted[:, 0])]
    assert found.shape == wanted.shape, "different particles or steps"
    np.testing.assert_array_equal(found[:, :3], wanted[:, :3], "step, id or type")
    for name, columns in QUANTITIES.items():
        size = np.abs(wanted[:, columns]).max()
        error = np.abs(found[:, columns] - wanted[:, columns]).max()
        # a torque about the axis of motion is pure rounding noise where nothing turns
        assert error <= max(RTOL * size, 1e-18), f"{name}: off by {error:.2e} of {size:.2e}"


def test_most_trajectories_are_those_of_loops_of_their_own():
    texts = [(case.values[0] / "in.case").read_text() for case in cases()]
    assert sum(RARE.search(text) is None for text in texts) > 0.7 * len(texts)


def test_massflow_file_is_that_of_liggghts(tmp_path):
    case = FOLDERS[0] / "o_massflow_multiple"
    for file in case.iterdir():
        shutil.copy(file, tmp_path)
    (tmp_path / "massflow.txt").unlink()
    run_script(tmp_path / "in.case", root=tmp_path)
    assert (tmp_path / "massflow.txt").read_text() == (case / "massflow.txt").read_text()
