"""The library in five lines, on formulas instead of the engine."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from calibrate import CalibrationError, load
from calibrate.cli import diagnose_study, running
from calibrate.cli.joint import study
from calibrate.report.record_file import read_record
from calibrate.runs.campaign import Campaign
from tests.calibrate import stand_in
from tests.calibrate.causes.studies import FEW
from tests.calibrate.questions.planted import bench, planted_study


@pytest.fixture
def on_formulas(monkeypatch):
    """Let campaigns run on formulas in this process."""

    class Inline(Campaign):
        """Asks the formulas."""

        def _results(self, specs, todo):
            for index in todo:
                yield index, stand_in.execute(specs[index], self.root)

    def render(directory: Path) -> Path:
        msg = f"{directory}: formulas have no pictures"
        raise OSError(msg)

    monkeypatch.setattr(running, "Campaign", Inline)
    monkeypatch.setattr(running, "stored_case", stand_in.stored)
    monkeypatch.setattr(study, "render_case", render)


def test_five_lines(tmp_path, rng, on_formulas, capsys) -> None:
    data = planted_study(tmp_path, bench("A", "glued"), rng, design="runs = 60")
    loaded = load(str(data.path))
    assert loaded.identify(tmp_path / "out").sentences == ()
    result = loaded.calibrate(tmp_path / "out")
    assert list(result.table().index) == ["mu_pp", "mu_roll_pp"]
    assert result.figure().axes
    assert "Stopped" in capsys.readouterr().out
    assert read_record(tmp_path / "out" / "calibration.json")["joint"]["unknowns"]
    assert (tmp_path / "out" / "report.html").exists()


def test_a_diagnosis_is_one_line_more(tmp_path, rng, on_formulas, monkeypatch) -> None:
    monkeypatch.setitem(diagnose_study.diagnose_study.__kwdefaults__, "options", FEW)
    data = planted_study(tmp_path, bench("A", "glued"), rng, design="runs = 60\ncheck_seeds = 2")
    found = load(data.path).diagnose(tmp_path / "out")
    assert found.sentences
    table = found.table()
    assert {"probability", "strength", "low_95", "high_95", "absorbed", "detectable"} <= set(table)
    assert table["probability"].sum() <= 1.0
    assert found.figure().axes
    record = read_record(tmp_path / "out" / "diagnosis.json")
    assert record["sentences"] == found.sentences


def test_a_missing_study_is_a_plain_error(tmp_path) -> None:
    with pytest.raises(CalibrationError, match="nowhere"):
        load(tmp_path / "nowhere.toml")


def test_a_script_without_a_guard_is_told_so(tmp_path, rng) -> None:
    data = planted_study(tmp_path, bench("A", "glued"), rng, design="runs = 60")
    script = tmp_path / "mine.py"
    script.write_text(
        "from calibrate import load\n"
        f"load({str(data.path)!r}).calibrate({str(tmp_path / 'out')!r})\n"
    )
    ended = subprocess.run(
        [sys.executable, str(script)], capture_output=True, text=True, check=False
    )
    assert ended.returncode == 1
    last = ended.stderr.strip().splitlines()[-1]
    assert "mine.py" in last
    assert 'if __name__ == "__main__":' in last
    assert not (tmp_path / "out").exists()
