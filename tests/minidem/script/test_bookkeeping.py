"""Commands that only concern how LIGGGHTS computes, and pairs that do not see each other."""

from __future__ import annotations

import numpy as np
import pytest

from minidem import run_script
from minidem.errors import ScriptError
from tests.minidem.script.test_acceptance import after

BEFORE_BOX = """processors 1 1 1
package omp 2
box tilt large
newton off off
"""
HARMLESS = """partition yes 1 print "hello  world" file said.txt newline no
partition no 1 print 'not this' file not.txt
partition yes * variable two equal 1+1
pair_modify mix arithmetic shift yes table 12 tail no compute yes
dielectric 2.0
kspace_style none
special_bonds lj 0 0 1
run_style verlet
suffix on
modify_timing verbose
min_style cg
min_modify dmax 0.1
force_dt_reset yes
compute turns all erotate/sphere update_on_run_end yes
write_restart_on_signal yes
neigh_modify include all binsize 0.01 once no exclude none
print "${two}" file two.txt
"""


def test_harmless_commands_are_accepted(tmp_path):
    script = after(HARMLESS + "dump d all custom 3 d.dump id vx vy vz fx fy fz\n")
    script = script.replace("units si\n", "units si\n" + BEFORE_BOX)
    (tmp_path / "in.s").write_text(script)
    (tmp_path / "plain").mkdir()
    plain = after("dump d all custom 3 d.dump id vx vy vz fx fy fz\n")
    (tmp_path / "plain" / "in.s").write_text(plain)
    run_script(tmp_path / "in.s", root=tmp_path)
    run_script(tmp_path / "plain" / "in.s", root=tmp_path / "plain")
    assert (tmp_path / "d.dump").read_bytes() == (tmp_path / "plain" / "d.dump").read_bytes()
    assert (tmp_path / "said.txt").read_text() == "hello  world"
    assert (tmp_path / "two.txt").read_text() == "2\n"
    assert not (tmp_path / "not.txt").exists()
    log = (tmp_path / "log.liggghts").read_text()
    for word in ("package", "suffix"):
        assert f"WARNING: {word} is passed over" in log


def test_excluded_pairs_do_not_touch(tmp_path):
    lines = "group one id 1\ngroup two id 2\nneigh_modify exclude group two one\n"
    lines += "dump d all custom 3 d*.dump id vy\ndump_modify d sort id\n"
    (tmp_path / "in.s").write_text(after(lines) + "neigh_modify exclude none\nrun 3\n")
    run_script(tmp_path / "in.s", root=tmp_path)
    first, second = (np.loadtxt(tmp_path / f"d{step}.dump", skiprows=9) for step in (3, 6))
    assert first[:, 1].tolist() == [0.0, 0.0]
    assert second[0, 1] < 0.0 < second[1, 1]


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("neigh_modify exclude type 1 2", "types go from 1 to 1"),
        ("neigh_modify exclude group all none", "Could not find group 'none'"),
        ("neigh_modify exclude molecule all", "spheres have none"),
        ("neigh_modify exclude pair 1 2", "unknown neigh_modify exclude 'pair'"),
        ("neigh_modify include some", "use neigh_modify exclude group"),
        ("neigh_modify once yes", "none is inserted; take it out"),
        ("neigh_modify cluster yes", "take it out"),
        ("pair_modify compute no", "use neigh_modify exclude group all all"),
        ("pair_modify mix any", "known: geometric, arithmetic, sixthpower"),
        ("package omp 2", "move it before create_box"),
        ("box tilt large", "move it before create_box"),
        ("run_style respa 2 2", "known: verlet"),
        ("kspace_style ewald 1e-4", "known: none"),
        ("partition maybe 1 print x", "known: yes, no"),
        ("partition yes 1 prnt x", "unknown command 'prnt'"),
        ("mass 1 2.0", "use set type N density RHO"),
        ("suffix", "suffix: expected on, off or a suffix"),
        ("print x newline maybe", "print newline takes yes or no"),
        ("compute a all ke update_on_run_end maybe", "update_on_run_end setting 'maybe'"),
        ("compute a all ke update_on_run_end", "expected one of yes, no"),
        ("modify_timing maybe", "known: on, off, verbose"),
        ("dump a all atom 1 f", "has it in its manual only; use dump custom"),
        ("compute a all coord/gran", "in its manual only; use contact/atom"),
        ("fix a all couple/lb/onetoone", "neither a fluid nor a coupled program"),
        ("fix a all property/atom/timetracer", "is property/atom/regiontracer/time"),
        (
            "fix a all custom_property/global youngsModulus peratomtype 5e6",
            "'youngsModulus' is given by fix m1 already; unfix m1 first",
        ),
    ],
)
def test_mistake_names_file_and_line(tmp_path, line, message):
    text = after(line)
    (tmp_path / "in.s").write_text(text)
    with pytest.raises(ScriptError) as error:
        run_script(tmp_path / "in.s", root=tmp_path)
    assert message in str(error.value)
    assert f"in.s:{text.splitlines().index(line) + 1}:" in str(error.value)
