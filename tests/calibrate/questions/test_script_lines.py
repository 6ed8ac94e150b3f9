"""Exported lines: what they hold, and that real LIGGGHTS takes them."""

from __future__ import annotations

import json
import subprocess
from dataclasses import replace
from pathlib import Path

import pytest

from calibrate.errors import CalibrationError
from calibrate.questions.export import script_of_joint
from calibrate.questions.joint.calibration import calibrate_jointly
from calibrate.questions.script_lines import Script, ScriptNumber, script_from, script_lines
from liggghts_io.case.liggghts import find_liggghts
from tests.calibrate.questions import planted
from tests.calibrate.questions.planted import bench, planted_study

SCRIPT = """
atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
units si
region domain block 0 0.1 0 0.1 0 0.1 units box
create_box {types} domain
neighbor 0.002 bin
neigh_modify delay 0
{lines}
pair_style gran model {model}
pair_coeff * *
timestep 1e-6
fix gravity all gravity 9.81 vector 0 0 -1
fix wall all wall/gran model {model} primitive type 2 zplane 0.0
fix integrate all nve/sphere
create_atoms 1 single 0.05 0.05 0.0004
create_atoms 1 single 0.0509 0.05 0.0004
set group all diameter 0.001 density 2500
run 10
print "all taken"
"""
FOUND = {
    name: ScriptNumber(name, 0.3 + 0.05 * k, 0.2, 0.9, "found")
    for k, name in enumerate(
        [f"{word}_{end}" for word in ("mu", "mu_roll", "e") for end in ("pp", "pw/steel")]
    )
}


def script(**more: ScriptNumber) -> Script:
    """Return a script of one material on one wall."""
    return Script("Sand on steel", "Sand", ("steel",), 5e6, 0.25, {**FOUND, **more})


def test_numbers_found_with_coarse_grains_say_so():
    assert "coarse" not in script_lines(script())
    e = FOUND["e_pp"].value
    enlarged = replace(script(), coarse_graining=1.2)
    coarse = (1.0 - 1.2 * (1.0 - e**2)) ** 0.5
    lines = script_lines(enlarged)
    assert f"# grains take {coarse:.6g} between each other instead of {e:.6g}" in lines
    assert script_lines(script()) == "".join(
        f"{line}\n" for line in lines.splitlines() if "grains " not in line
    )
    assert script_from(json.loads(json.dumps(enlarged.record()))) == enlarged


def cohesive() -> Script:
    """Return the same with cohesion, which no data determine, and nothing at the wall."""
    number = ScriptNumber("cohesion_J_m3", 2000.0, known="not determined")
    return script(cohesion_J_m3=number)


def test_numbers_stand_where_liggghts_looks_for_them() -> None:
    lines = [one.split() for one in script_lines(script()).splitlines() if one[0] != "#"]
    held = {words[4]: [float(one) for one in words[7:]] for words in lines if len(words) > 8}
    # Symmetric, grains first.
    assert held["coefficientFriction"][:3] == pytest.approx([0.3, 0.35, 0.35])
    assert held["coefficientRollingFriction"][:3] == pytest.approx([0.4, 0.45, 0.45])
    assert held["coefficientRestitution"][:3] == pytest.approx([0.5, 0.55, 0.55])


def test_cohesion_has_a_line_when_it_is_part_of_the_model() -> None:
    assert "cohesionEnergyDensity" not in script_lines(script())
    text = script_lines(cohesive())
    assert "cohesionEnergyDensity peratomtypepair 2 2000 0 0 0" in text
    assert "cohesion_J_m3: NOT DETERMINED" in text
    assert "cohesion sjkr" in text


def test_what_the_study_lacks_is_left_out_with_a_comment() -> None:
    numbers = {name: one for name, one in FOUND.items() if name != "mu_pp"}
    text = script_lines(Script("t", "Sand", ("steel",), 5e6, 0.25, numbers))
    assert "# coefficientFriction: the study gives no value; left out" in text


def test_plain_data_bring_it_back() -> None:
    assert script_from(json.loads(json.dumps(cohesive().record()))) == cohesive()
    with pytest.raises(CalibrationError, match="holds no numbers"):
        script_from({"numbers": 3})


@pytest.mark.liggghts
@pytest.mark.parametrize("one", [script(), cohesive()], ids=["plain", "cohesive"])
def test_liggghts_takes_the_lines(one: Script, tmp_path: Path) -> None:
    program = find_liggghts()
    if program is None:
        pytest.skip("LIGGGHTS is not installed")
    lines = script_lines(one)
    model = next(a for a in lines.splitlines() if "pair_style" in a).partition("model ")[2]
    path = tmp_path / "in.script"
    path.write_text(SCRIPT.format(types=2, lines=lines, model=model))
    ended = subprocess.run(
        [str(program), "-in", path.name], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert ended.returncode == 0, ended.stdout[-2000:]
    assert "all taken" in ended.stdout


def test_a_free_cohesion_is_exported(tmp_path: Path, rng) -> None:
    more = "[parameter.cohesion_J_m3]\nrange = [0.0, 20000.0]"
    data = planted_study(
        tmp_path, bench("A", "glued"), rng, free=("mu_pp",), design="runs = 60", more=more
    )
    result = calibrate_jointly(data, planted.run)
    numbers = script_of_joint(result, "A").numbers
    assert numbers["cohesion_J_m3"].known == "not determined"  # the formulas know no cohesion
    assert numbers["mu_roll_pp"].known == "given"
