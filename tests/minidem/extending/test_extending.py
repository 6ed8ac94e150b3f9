"""A fix, a compute and a dump column of one's own, each one file in the folder ``own_words``.

Nothing of the package is changed for them: it is enough to import the file before the script runs.
A file of the package differs only in that the ``__init__`` of its folder has the line that imports
it.
"""

from __future__ import annotations

import ast
import sys
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

import minidem
from minidem import ScriptError, run_script
from minidem.output.columns import COLUMNS
from minidem.world.compute import COMPUTES
from minidem.world.fix import FIXES

OWN = Path(__file__).parent / "own_words"
STIFFNESS, DENSITY, RADIUS = 2.0, 1000.0, 0.005  # N/m, kg/m3, m
START = 0.02  # m, where the ball starts; the spring pulls it to the origin
DT = 1e-4  # s
SETTINGS = f"""atom_style granular
atom_modify map array
newton off
communicate single vel yes
boundary f f f
units si
BOX
neighbor 0.01 bin
fix m1 all property/global youngsModulus peratomtype 5e6
fix m2 all property/global poissonsRatio peratomtype 0.3
fix m3 all property/global coefficientRestitution peratomtypepair 1 0.6
fix m4 all property/global coefficientFriction peratomtypepair 1 0.5
pair_style gran model hertz tangential history
pair_coeff * *
timestep {DT}
PARTICLES
fix integr all nve/sphere
fix s all toy/spring {STIFFNESS} 0 0 0
compute v all toy/speed
variable energy equal f_s[1]
thermo_style custom step ke f_s[1] f_s[2] c_v v_energy
thermo_modify norm no
thermo 100
dump d all custom 100 d_*.dump id x z vx c_v height_mm
dump_modify d format "%d %.17g %.17g %.17g %.17g %.17g"
"""
BOX = "region b block -0.1 0.1 -0.1 0.1 -0.1 0.1\ncreate_box 1 b"
PARTICLES = f"""create_atoms 1 single {START} 0 0
set atom 1 diameter {2 * RADIUS} density {DENSITY}"""
BEGIN = SETTINGS.replace("BOX", BOX).replace("PARTICLES", PARTICLES)


@pytest.fixture(autouse=True)
def own_words(monkeypatch):
    """Make the words of the folder known for one test; the tables are left as they were."""
    for table in (FIXES, COMPUTES, COLUMNS):
        monkeypatch.setattr(table, "_entries", dict(table))
    monkeypatch.syspath_prepend(str(OWN))
    for path in OWN.glob("*.py"):
        monkeypatch.delitem(sys.modules, path.stem, raising=False)
        import_module(path.stem)


def run(folder, text: str) -> None:
    folder.mkdir(exist_ok=True)
    (folder / "in.s").write_text(text)
    run_script(folder / "in.s", root=folder)


def thermo(folder) -> np.ndarray:
    """Return the rows of all runs: step ke f_s[1] f_s[2] c_v v_energy."""
    rows = [line.split() for line in (folder / "log.liggghts").read_text().splitlines()]
    return np.array([row for row in rows if len(row) == 6 and row[0].isdigit()], float)


def frame(folder, step: int) -> np.ndarray:
    """Return the ball in a dump: id x z vx c_v height_mm."""
    return np.loadtxt(folder / f"d_{step}.dump", skiprows=9)


def test_the_force_of_a_fix_of_ones_own(tmp_path):
    """A ball on a spring swings as a cosine; energy goes back and forth."""
    run(tmp_path, BEGIN + "run 1000\n")
    mass = DENSITY * 4.0 / 3.0 * np.pi * RADIUS**3
    pace = np.sqrt(STIFFNESS / mass)
    for step in range(0, 1001, 100):
        # velocity Verlet changes the frequency by (w dt)^2 / 24, here 7e-7
        assert frame(tmp_path, step)[1] == pytest.approx(
            START * np.cos(pace * step * DT), abs=1e-4 * START
        )
    rows = thermo(tmp_path)
    assert rows[0, 2] == pytest.approx(0.5 * STIFFNESS * START**2)
    np.testing.assert_allclose(rows[:, 1] + rows[:, 2], rows[0, 2], rtol=1e-4)
    np.testing.assert_array_equal(rows[:, 3], rows[:, 0])  # it has acted once per step
    np.testing.assert_array_equal(rows[:, 5], rows[:, 2])


def test_a_compute_and_a_column_of_ones_own(tmp_path):
    run(tmp_path, BEGIN + "run 100\n")
    _, _, z, vx, speed, height = frame(tmp_path, 100)
    assert speed == abs(vx) > 0.1
    assert thermo(tmp_path)[-1, 4] == pytest.approx(speed, rel=1e-7)
    assert height == 1000.0 * (z - RADIUS)


def test_a_fix_of_ones_own_goes_on_after_a_restart(tmp_path):
    run(tmp_path / "first", BEGIN + "run 250\nwrite_restart r.npz\nrun 250\n")
    (tmp_path / "second").mkdir()
    (tmp_path / "first" / "r.npz").rename(tmp_path / "second" / "r.npz")
    again = SETTINGS.replace("BOX", "read_restart r.npz").replace("PARTICLES", "")
    run(tmp_path / "second", again + "run 250\n")
    wanted = thermo(tmp_path / "first")
    found = thermo(tmp_path / "second")
    assert found[-1, 0] == found[-1, 3] == 500
    np.testing.assert_array_equal(found, wanted[-len(found) :])
    np.testing.assert_array_equal(frame(tmp_path / "second", 500), frame(tmp_path / "first", 500))


def test_a_fix_of_ones_own_is_taken_away(tmp_path):
    run(tmp_path, BEGIN + "run 100\nthermo_style custom step ke\nunfix s\nrun 100\n")
    assert "spring s lets go after 100 steps" in (tmp_path / "log.liggghts").read_text()
    assert frame(tmp_path, 200)[3] == frame(tmp_path, 100)[3] < 0.0


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("fix s2 all toy/sprin 1 0 0 0", "did you mean 'toy/spring'?"),
        ("fix s2 all toy/spring 1 0 0", "usage: fix ID GROUP toy/spring K X Y Z"),
        ("fix s2 all toy/spring 1 0 0 zero", "fix toy/spring: expected a number, found 'zero'"),
        ("fix s2 all toy/spring -1 0 0 0", "fix toy/spring: expected a number above zero"),
        ("compute v2 all toy/sped", "did you mean 'toy/speed'?"),
        ("dump d2 all custom 1 f height_m", "did you mean 'height_mm'?"),
        ("variable x equal f_s[3]\nprint ${x}", "fix toy/spring has no value [3]"),
    ],
)
def test_a_mistake_in_ones_own_word_is_named(tmp_path, line, message):
    with pytest.raises(ScriptError) as error:
        run(tmp_path, BEGIN + line + "\n")
    assert message in str(error.value)


def test_only_the_fixes_know_one_another():
    """Elsewhere a fix is what `Fix` says, so that a new one needs no other change."""
    names = {style.__name__ for style in FIXES.values()} - {"Spring"}
    package = Path(minidem.__file__).parent
    homes = {"fixes", "averages"}  # the latter are output
    outside = [path for path in package.rglob("*.py") if not homes & {*path.parts[-3:-1]}]
    assert len(names) > 10
    assert len(outside) > 60
    for path in outside:
        words = {
            node.id for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.Name)
        }
        assert not names & words, path
