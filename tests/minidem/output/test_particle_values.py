"""Computes per particle and of groups, held against what LIGGGHTS writes for them."""

from __future__ import annotations

import re

import numpy as np
import pytest

from minidem import run_script
from minidem.errors import ScriptError
from tests.minidem.output import scenes
from tests.twins.references import places

HEAD = (
    scenes.HEAD.replace("boundary f f m", "boundary p f m")
    .replace("fix mm all move/mesh mesh cm wiggle amplitude 0.001 0 0.001 period 0.01\n", "")
    .replace(" wear finnie", "")
)
LINES = """create_atoms 1 single 0.199 0.05 0.1 units box
create_atoms 2 single -0.1955 0.0505 0.1 units box
set atom 8 diameter 0.008 density 2500 vx 0.5
set atom 9 diameter 0.0076 density 2500 vx 0 omegaz 30
group odd type 1
compute ct all contact/atom
compute ct2 odd contact/atom skin 0.001
compute co all coord/atom 0.0088
compute co2 odd coord/atom 0.0088 mix yes
compute co3 all coord/atom 0.0088 1 2 *
compute st all stress/atom
compute st2 odd stress/atom pair
compute st3 all stress/atom virial
compute te all temp
compute te2 odd temp
compute_modify te2 dynamic yes extra 0
compute pr all pressure thermo_temp
compute pr2 all pressure te pair
compute pe all pe
compute pea all pe/atom
compute ea odd erotate/sphere/atom
compute gy all gyration
region rr block -0.02 0.05 -0.2 0.2 -0.1 0.1 units box
compute rg all reduce/region rr sum vx c_ct c_st[3]
compute rx all reduce max x c_ct vz replace 1 3
compute rs all reduce sum c_st[1] c_st[2] c_st[3] c_st[4] c_st[5] c_st[6]
dump a all custom 10 a*.dump id c_ct c_ct2 c_co c_co2 c_co3[1] c_co3[2] &
 c_st[1] c_st[2] c_st[3] c_st[4] c_st[5] c_st[6] &
 c_st2[1] c_st2[4] c_st3[3] c_pea c_ea
dump_modify a format "%d %g %g %g %g %g %g %.11g %.11g %.11g %.11g %.11g &
 %.11g %.11g %.11g %.11g %g %.10g" sort id
thermo_style custom step atoms ke c_te c_te[1] c_te[4] c_te2 c_te2[6] &
 c_thermo_temp c_pr c_pr[1] c_pr[5] &
 c_pr2 c_pr2[3] c_pe c_gy c_gy[2] c_gy[4] c_rg[1] c_rg[2] &
 c_rg[3] c_rx[1] c_rx[2] c_rx[3] c_rs[1] c_rs[4]
thermo 10
thermo_modify lost ignore norm no format float %.9g
run 1
run 200
"""
# LIGGGHTS works out the forces of sliding contacts in the step, minidem afterwards.
STRESS = 1e-8


def thermo(log: str) -> np.ndarray:
    """Return the rows of the thermo table."""
    rows = [line.split() for line in log.splitlines() if re.match(r" +\d+ +9 ", line)]
    return np.array(rows, np.float64)


def values(dump: str) -> np.ndarray:
    """Return the rows of a dump."""
    return np.array([line.split() for line in dump.splitlines()[9:]], np.float64)


def compare(mine: dict[str, str], theirs: dict[str, str]) -> None:
    """Compare all frames and the thermo table."""
    for name in theirs:
        if name.endswith(".dump"):
            np.testing.assert_allclose(
                values(mine[name]), values(theirs[name]), rtol=STRESS, atol=1e-14, err_msg=name
            )
    log = "log.liggghts"
    assert len(thermo(theirs[log])) > 20
    np.testing.assert_allclose(thermo(mine[log]), thermo(theirs[log]), rtol=1e-7, atol=1e-12)


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Return the files that minidem writes, and its log."""
    folder = tmp_path_factory.mktemp("mine")
    found = scenes.run_minidem(folder, scenes.scene(LINES, HEAD))
    return found | {"log.liggghts": (folder / "log.liggghts").read_text()}


def test_values_are_those_of_liggghts(files):
    log, frame = scenes.STORED / "computes.log", scenes.STORED / "computes_a150.dump"
    compare(files, {"log.liggghts": log.read_text(), "a150.dump": frame.read_text()})


@pytest.mark.liggghts
def test_all_values_are_those_of_liggghts(files, tmp_path):
    theirs = scenes.run_liggghts(tmp_path, scenes.scene(LINES, HEAD))
    compare(files, theirs | {"log.liggghts": (tmp_path / "log.liggghts").read_text()})


PLAIN = "\n".join([*places.header("f f f", 0.05), ""])
TWO = """create_atoms 1 single 0 0 0 units box
create_atoms 1 single 0.0099 0 0 units box
set group all density 2500 diameter 0.01
set atom 1 vx 0.3
fix i all nve/sphere
compute s all stress/atom
compute p all reduce sum c_s[1]
thermo_style custom step c_p
thermo 1
run 0
print "sum $(c_p)"
run 1
print "sum $(c_p)"
"""
SUMS = (-0.003497579970308371, -0.0035737696207582)
RENUMBERED = TWO.replace("run 0\n", "run 0\nreset_timestep 100\n")


def sums(folder, run, script: str) -> list[float]:
    """Run a script and return the sums that it prints."""
    run(folder, script)
    log = (folder / "log.liggghts").read_text()
    return [float(x) for x in re.findall(r"^sum (\S+)$", log, re.MULTILINE)]


@pytest.mark.parametrize("script", [TWO, RENUMBERED])
def test_stresses_between_runs_are_of_the_forces_of_the_last_setup_or_step(tmp_path, script):
    """Behind `run 0` velocities are those that the forces were made of; numbers of LIGGGHTS."""
    found = sums(tmp_path, scenes.run_minidem, PLAIN + script)
    np.testing.assert_allclose(found, SUMS, rtol=1e-12)  # some digits less than a double has


@pytest.mark.liggghts
def test_stresses_between_runs_are_those_of_liggghts(tmp_path):
    found = sums(tmp_path, scenes.run_liggghts, PLAIN + TWO)
    np.testing.assert_allclose(found, SUMS, rtol=1e-12)  # of another version of its compiler


GLANCING = """create_atoms 1 single 0 0 0 units box
create_atoms 1 single 0.01001 0.001 0 units box
set group all density 2500 diameter 0.01
set atom 1 vx 0.5 vy 0.1 omegaz 40
fix i all nve/sphere
compute s all stress/atom pair
compute c all contact/atom
dump a all custom 1 d*.dump id x y fx fy c_s[1] c_s[2] c_s[4] c_c
dump_modify a sort id format "%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g %g"
run 1
run 300
"""


def test_stresses_are_of_the_forces_that_act_also_where_they_are_cut_to_nothing(tmp_path):
    """At the end of a damped collision `limitForce` lets nothing act, in LIGGGHTS, too."""
    plain = PLAIN.replace("tangential history", "tangential history limitForce on")
    plain = plain.replace("peratomtypepair 1 0.5", "peratomtypepair 1 0.2")
    found = scenes.run_minidem(tmp_path, plain + GLANCING)
    frames = np.array([values(found[f"d{step}.dump"]) for step in range(2, 302)])
    (x, y), (fx, fy) = (frames[:, 0, 1:3] - frames[:, 1, 1:3]).T, frames[:, 0, 3:5].T
    wanted = -np.stack([x * fx, y * fy, x * fy], axis=1)
    stress = frames[:, :, 5:8].sum(axis=1)
    touching = frames[:, 0, 8] == 1.0
    assert np.count_nonzero(touching & (fx == 0.0)) > 10
    np.testing.assert_allclose(stress, wanted, rtol=0, atol=STRESS * np.abs(wanted).max())


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("compute a all contact/atom skim 1", "expected 'skin'"),
        ("compute a all coord/atom 0", "above zero"),
        ("compute a all coord/atom 1 3", "no range of types between 1 and 2"),
        ("compute a all stress/atom pairs", "did you mean 'pair'?"),
        ("compute a all pressure b", "is no compute temp"),
        ("compute a all reduce/region r sum vx", "unknown region 'r'"),
        ("compute a all reduce max vx vy replace 1 3", "two different inputs"),
        ("compute_modify thermo_temp dinamic yes", "did you mean 'dynamic'?"),
        ("compute a all stress/atom\ndump a all custom 1 f id c_a[7]\nrun 0", "compute a has no"),
    ],
)
def test_mistake_names_file_and_line(tmp_path, line, message):
    script = scenes.write(tmp_path, scenes.scene(line + "\n"))
    with pytest.raises(ScriptError) as error:
        run_script(script, root=tmp_path)
    assert message in str(error.value)
