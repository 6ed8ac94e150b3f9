"""The tutorial notebook does what it says, from its first cell to its last."""

from __future__ import annotations

import tomllib
from pathlib import Path

import nbformat
import pytest

from calibrate.report.record_file import read_record
from tests.docs.notebook import TUTORIAL, executed, text_of
from tests.paths import ROOT


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory):
    """Return the notebook after all its cells ran, and the directory with its results."""
    folder = tmp_path_factory.mktemp("tutorial")
    with pytest.MonkeyPatch.context() as patch:
        # A home that cannot be written, as on a build server, must not matter.
        patch.setenv("JUPYTER_RUNTIME_DIR", str(folder / "runtime"))
        patch.setenv("IPYTHONDIR", str(folder / "ipython"))
        notebook = executed(folder)
    return notebook, folder / "docs" / "hopper"


def test_every_cell_shows_something_and_the_answer_is_stored(run) -> None:
    notebook, out = run
    shown = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert all(cell.outputs for cell in shown)
    assert (out / "report.html").is_file()
    assert (out / "calibration.json").is_file()
    pictures = [o for cell in shown for o in cell.outputs if "image/png" in o.get("data", {})]
    assert len(pictures) == 1


def test_the_planted_values_are_found(run) -> None:
    notebook, out = run
    truth = tomllib.loads((ROOT / "cases/plain_script/truth.toml").read_text())["parameters"]
    told = next(c.source for c in notebook.cells if "planted values are" in c.source)
    for row in read_record(out / "calibration.json")["joint"]["unknowns"]:
        assert f"`{row['name']} = {truth[row['name']]:g}`" in told
        assert row["low_95"] <= truth[row["name"]] <= row["high_95"]


def test_progress_stands_in_one_place(run) -> None:
    """Each bar of a terminal is one line of a notebook, not a line every other second."""
    notebook, _ = run
    cell = next(c for c in notebook.cells if "study.calibrate(" in c.source)
    lines = text_of(cell).splitlines()
    assert sum("learning from" in line or "First design" in line for line in lines) == 1
    assert len(lines) < 15


def test_the_notebook_in_the_repository_shows_what_it_showed() -> None:
    stored = nbformat.read(TUTORIAL, as_version=4)
    shown = [cell for cell in stored.cells if cell.cell_type == "code"]
    assert all(cell.outputs for cell in shown), "run: python -m tests.docs.notebook"
    assert str(Path.home()) not in TUTORIAL.read_text(encoding="utf-8")
    assert "/tmp/" not in TUTORIAL.read_text(encoding="utf-8")
