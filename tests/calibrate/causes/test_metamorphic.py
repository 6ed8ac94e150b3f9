"""The same study told otherwise: in other units, of grains with another name."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from pathlib import Path

import pytest

from calibrate.causes.studies.from_study import with_effects
from calibrate.causes.studies.twins import twin_cases
from calibrate.causes.studies.what_if import diagnose_stored
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.runs import Runs, make_runs
from calibrate.study.data import StudyData, load_data
from tests.calibrate.causes import studies

HIDDEN = {"plate_tilt_deg": 4.0}
LOOKED_AT = ("plate_tilt_deg", "cohesion_J_m3", "mass_flow_factor", "camera_tilt_deg")
OTHER = {"deg": ("rad", math.pi / 180.0), "s": ("ms", 1000.0), "g": ("kg", 0.001)}


@pytest.fixture(scope="module")
def told(tmp_path_factory):
    """Return a study, its runs with and without causes, and what it says of them."""
    data = studies.study(tmp_path_factory.mktemp("plain"), HIDDEN, 5, studies.SHEAR)
    base, forms = studies.base_runs(data), forms_of(with_effects(data))
    effects = data.study.layout.effects
    twins = twin_cases(forms, base, effects, LOOKED_AT, 12)
    runs = base.joined(make_runs(twins, "", studies.run, forms))
    return data, runs, _evidences(data, runs)


def _evidences(data: StudyData, runs: Runs) -> dict[str, float]:
    found = diagnose_stored(data, runs, options=studies.FEW).found
    return {one.name: found.log_ratio(one.name) for one in found.board.candidates}


def _written(data: StudyData, folder: Path, text: str) -> StudyData:
    path = folder / data.path.name
    path.write_text(text, encoding="utf-8")
    return load_data(path)


def _in_other_units(text: str) -> str:
    def changed(match: re.Match[str]) -> str:
        unit, value, se = match.groups()
        other, times = OTHER[unit]
        return f'unit = "{other}"\nvalue = {float(value) * times!r}\nse = {float(se) * times!r}'

    return re.sub(r'unit = "(\w+)"\nvalue = (\S+)\nse = (\S+)', changed, text)


def test_units_change_nothing(told, tmp_path: Path) -> None:
    data, runs, evidences = told
    assert evidences["plate_tilt_deg"] > 3.0
    other = _written(data, tmp_path, _in_other_units(data.path.read_text(encoding="utf-8")))
    assert {one.unit for one in other.study.targets} == {"rad", "ms", "kg"}
    # A value in another unit and back differs in the last digit.
    assert _evidences(other, runs) == pytest.approx(evidences, abs=1e-6)


def test_names_of_grains_change_nothing(told, tmp_path: Path) -> None:
    # To the same tolerance: what is left is the order of sums.
    data, runs, evidences = told
    text = data.path.read_text(encoding="utf-8")
    for key in ("name", "material"):
        text = text.replace(f'{key} = "A"', f'{key} = "Zirconia 9"')
    other = _written(data, tmp_path, text)
    specs = [replace(s, particle=replace(s.particle, name="Zirconia 9")) for s in runs.specs]
    assert _evidences(other, Runs(tuple(specs), runs.table)) == pytest.approx(evidences, abs=1e-6)
