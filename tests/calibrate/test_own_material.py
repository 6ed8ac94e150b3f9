"""The README's study of one's own, followed literally with a bulk that nobody here knows."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path

import pytest

from calibrate.cli import main as cli
from calibrate.study.cases import case_spec
from calibrate.study.load import load_study
from calibrate.study.resources import cases_directory
from liggghts_io import case_id
from liggghts_io.materials import CONTACT_PARAMETERS

# Cut down to some hundred grains: a run takes half a second, and the physics is that of a toy.
TINY = {
    "heap": {"pour_grains": 160.0, "pour_tau": 20.0, "settle_tau": 6.0, "pour_stages": 2.0},
    "plate_impact": {"mass_fraction": 0.01, "flight_s": 0.28},
}
FEW = "runs = 40\nstart = 12\ncheck_draws = 1\n"
"""Of the joint calibration beside the stages."""


@pytest.fixture
def readme() -> str:
    return (cases_directory() / "README.md").read_text(encoding="utf-8")


@pytest.fixture
def folder(readme: str, tmp_path: Path, monkeypatch) -> Path:
    """Write the README's files into an empty folder, with a tiny apparatus, and go there."""
    files = dict(re.findall(r"^`([\w.]+)`\n\n```\w+\n(.*?)^```", readme, re.M | re.S))
    assert set(files) == {"particles.csv", "measured.csv", "beads.toml"}
    for name, values in TINY.items():
        pairs = ", ".join(f"{key} = {value}" for key, value in values.items())
        files["beads.toml"] += f'\n[[experiment]]\nname = "{name}"\napparatus = {{ {pairs} }}\n'
    for name, text in files.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("NO_COLOR", "1")
    return tmp_path


def bulkcal(*words: str) -> None:
    """Run a command, which must succeed."""
    with pytest.raises(SystemExit) as ended:
        cli.main(words)
    assert ended.value.code in (0, None)


@pytest.mark.slow
def test_a_bulk_that_nobody_knows_runs_from_its_table_to_its_report(
    readme: str, folder: Path, capsys
):
    study = folder / "beads.toml"
    study.write_text(study.read_text().replace("[design]\n", f"[design]\n{FEW}"))
    block = re.search(r"^```sh\n(.*?)^```", readme, re.M | re.S)
    assert block
    commands = [shlex.split(line) for line in block[1].splitlines()]
    assert [words[:2] for words in commands] == [
        ["bulkcal", "generate"], ["bulkcal", "run"], ["bulkcal", "calibrate"],
    ]  # fmt: skip
    generate, run, calibrate = (words[1:] for words in commands)
    small = [f"{key}={value}" for key, value in TINY["heap"].items()]
    bulkcal(*generate, *(word for pair in small for word in ("-a", pair)))
    bulkcal(*run)
    assert "Glass beads 1 mm, heap on a flat wall" in " ".join(capsys.readouterr().out.split())
    bulkcal(*calibrate)
    record = json.loads((folder / "beads" / "calibration.json").read_text())
    assert set(record["parameters"]) >= {"mu_pp", "mu_pw", "e_pp", "e_pw"}
    report = (folder / "beads" / "report.html").read_text(encoding="utf-8")
    assert "Glass beads on steel" in report
    assert "Measured by us, 2026" in report
    runs = (folder / "beads" / "runs.csv").read_text()
    # What the study and what the case calls them.
    assert runs.count(",Glass beads 1 mm,Glass beads 1 mm,steel,") == (8 + 2) * 2 + 2 * 2
    assert runs.count(",Glass beads 1 mm,Glass beads 1 mm,glued,") == 8 + 2 + 2


def test_the_same_bulk_inline(folder: Path):
    """Numbers under [[material]] give the same cases as the table."""
    path = folder / "beads.toml"
    tables = load_study(path)
    path.write_text(
        path.read_text().replace(
            '[[material]]\nname = "Glass beads 1 mm"',
            """[[material]]
name = "Glass beads 1 mm"
d10_um = 920
d50_um = 1000
d90_um = 1090
density_kg_m3 = 2500
flow_flat_g_s = 20
impact_mass_g = 30""",
        )
    )
    (folder / "particles.csv").unlink()
    inline = load_study(path)
    for place in tables.places:
        values = {(name, one): 0.5 for name in CONTACT_PARAMETERS for one in tables.instances(name)}
        assert case_id(case_spec(inline, place, values, 1)) == case_id(
            case_spec(tables, place, values, 1)
        )


@pytest.mark.parametrize(
    ("column", "value"), [("flow_flat_g_s", ",20.0"), ("impact_mass_g", ",30.0")]
)
def test_what_an_experiment_needs_is_missed_before_the_first_run(
    folder: Path, capsys, column: str, value: str
):
    table = folder / "particles.csv"
    table.write_text(table.read_text().replace(f",{column}", "").replace(value, ""))
    with pytest.raises(SystemExit) as ended:
        cli.main(["calibrate", "beads.toml", "--out", "beads"])
    assert ended.value.code == 2
    error = " ".join(capsys.readouterr().err.split())
    assert f"beads.toml:41: particle 'Glass beads 1 mm' has no {column}" in error
    assert not (folder / "beads").exists()
