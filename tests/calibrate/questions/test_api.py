"""The library in five lines, on formulas instead of the engine."""

from __future__ import annotations

import pytest

from calibrate import CalibrationError, api, load
from calibrate.runs.campaign import Campaign
from tests.calibrate import stand_in
from tests.calibrate.questions.planted import bench, planted_study


@pytest.fixture
def on_formulas(monkeypatch):
    """Let campaigns run on formulas in this process."""

    class Inline(Campaign):
        """Asks the formulas."""

        def _results(self, specs, todo):
            for index in todo:
                yield index, stand_in.execute(specs[index], self.root)

    monkeypatch.setattr(api, "Campaign", Inline)
    monkeypatch.setattr(api, "stored_case", stand_in.stored)


def test_five_lines(tmp_path, rng, on_formulas, capsys) -> None:
    data = planted_study(tmp_path, bench("A", "glued"), rng, design="runs = 60")
    study = load(str(data.path))
    assert study.identify(tmp_path / "out").sentences == ()
    result = study.calibrate(tmp_path / "out")
    assert list(result.table().index) == ["mu_pp", "mu_roll_pp"]
    assert result.figure().axes
    assert "Stopped" in capsys.readouterr().out


def test_a_missing_study_is_a_plain_error(tmp_path) -> None:
    with pytest.raises(CalibrationError, match="nowhere"):
        load(tmp_path / "nowhere.toml")
