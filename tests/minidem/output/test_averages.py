"""Means over time, stored values and displacements, held against what LIGGGHTS writes."""

from __future__ import annotations

import numpy as np
import pytest

from minidem import run_script
from minidem.errors import ScriptError
from tests.minidem.output import scenes

LINES = """group odd type 1
compute k all ke
compute ka all ke/atom
variable vv equal c_k*2+step
variable q atom vx*2+type
compute di all displace/atom
compute di2 odd displace/atom
fix at all ave/time 2 5 20 c_k v_vv f_cm[1] file at.txt
fix at2 all ave/time 10 1 20 c_k c_thermo_temp[3] ave running file at2.txt
fix at3 all ave/time 10 2 20 c_k c_thermo_temp[3] ave window 3 file at3.txt mode scalar
fix at4 all ave/time 10 2 20 c_k v_vv off 2 start 60 title1 "# hello" title2 "# two" file at4.txt
fix at5 all ave/time 10 2 20 c_k v_vv off 2 ave running overwrite file at5.txt
fix at6 all ave/time 2 1 20 c_k
fix at7 all ave/time 2 5 20 c_thermo_temp mode vector file at7.txt
fix at8 all ave/time 10 2 20 c_thermo_temp c_thermo_temp mode vector off 2 ave running &
  title3 "# three" file at8.txt
fix at9 all ave/time 20 1 20 f_at8[1] f_at8[2] mode vector ave window 2 file at9.txt
fix aa all ave/atom 5 3 20 vx c_ka v_q z
fix a2 odd ave/atom 5 1 10 vx
fix ss all store/state 0 x mass c_ka v_q xu
fix s2 odd store/state 30 vz com no
fix pa all property/atom col scalar yes no no 2.5
fix pv all property/atom vec vector yes no no 1 2 3
fix dm all diam/max
dump a all custom 20 a*.dump id xu yu zu xs ys zs f_aa[1] f_aa[2] f_aa[3] f_aa[4] &
 f_a2 f_ss[1] f_ss[2] f_ss[3] f_ss[4] f_ss[5] f_s2 &
 f_pa f_pv[2] c_di[1] c_di[4] c_di2[4]
dump b all xyz 40 b*.xyz
dump c odd xyz 40 c.xyz
thermo_style custom step atoms f_at[1] f_at[2] f_at6 f_at2[1] f_at3[1] f_at4[2] &
  f_at7[2] f_at8[4][1] f_at9[6][2]
thermo 20
thermo_modify lost ignore norm no format float %.9g
run 1
set group odd property/atom col 7
run 119
run 81
"""


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Return the files that minidem writes."""
    return scenes.run_minidem(tmp_path_factory.mktemp("mine"), scenes.scene(LINES))


def test_means_and_stored_values_are_those_of_liggghts(files):
    for name in ("at.txt", "at3.txt", "a200.dump"):
        stored = (scenes.STORED / f"averages_{name}").read_text()
        assert scenes.alike(files[name], stored, rtol=2e-5), name  # six digits are in the files


@pytest.mark.liggghts
def test_all_files_are_those_of_liggghts(files, tmp_path):
    theirs = scenes.run_liggghts(tmp_path, scenes.scene(LINES))
    assert len(theirs) > 20
    assert files == theirs


def test_stored_values_follow_their_particles(tmp_path):
    """Deleted particles take theirs along, the last takes the place of the first."""
    lines = """fix ss all store/state 0 x
fix pa all property/atom col vector no no no 2.5 4
set atom 3*4 property/atom col 7 8
compute di all displace/atom
run 20
delete_atoms group first
create_atoms 1 single 0.1 0.1 0.1 units box
dump a all custom 1 a*.dump id f_ss f_pa[1] f_pa[2] c_di[4]
run 0
write_restart s.restart
"""
    script = scenes.scene(
        "region r block -1 0.001 -0.005 0.005 -1 1\ngroup first region r\n" + lines
    )
    found = scenes.run_minidem(tmp_path, script)["a20.dump"]
    rows = np.array([line.split() for line in found.splitlines()[9:]], float)
    rows = rows[rows[:, 0].argsort()]
    np.testing.assert_allclose(rows[:, 1], [-0.02, 0.0082, -0.03, 0.03, 0.0295, 0.02, 0.0])
    np.testing.assert_allclose(rows[:, 2], [2.5, 2.5, 7, 7, 2.5, 2.5, 2.5])
    np.testing.assert_allclose(rows[:, 3], [4, 4, 8, 8, 4, 4, 4])
    assert rows[-1, 4] == 0.0


CORRELATIONS = """compute k all ke
compute te all temp
variable e equal c_k*1e4+step
fix c1 all ave/correlate 2 5 20 c_k v_e file c1.txt
fix c2 all ave/correlate 5 4 20 c_k c_te[3] v_e type upper ave running file c2.txt prefactor &
  100 start 33
fix c3 all ave/correlate 5 8 40 c_k c_te[3] v_e type full file c3.txt ave running overwrite
fix c4 all ave/correlate 1 3 10 c_k c_te[3] v_e type auto/upper file c4.txt title1 "# a" &
  title2 "# b" title3 "# c"
run 57
run 100
"""


def test_correlations_are_those_of_liggghts(tmp_path):
    found = scenes.run_minidem(tmp_path, scenes.scene(CORRELATIONS))
    stored = (scenes.STORED / "correlation_c2.txt").read_text()
    assert scenes.alike(found["c2.txt"], stored, rtol=2e-5)  # six digits are in the files


@pytest.mark.liggghts
def test_all_correlations_are_those_of_liggghts(tmp_path):
    script = scenes.scene(CORRELATIONS)
    mine = scenes.run_minidem(tmp_path / "mine", script)
    theirs = scenes.run_liggghts(tmp_path / "theirs", script)
    assert len(theirs) == 4
    assert mine == theirs


def test_pictures_are_skipped_with_a_warning(tmp_path):
    lines = "dump p all image 1 p*.ppm type type zoom 2\ndump_modify p backcolor white\nrun 1\n"
    scenes.run_minidem(tmp_path, scenes.scene(lines))
    assert "minidem makes no pictures" in (tmp_path / "log.liggghts").read_text()
    assert not list(tmp_path.glob("p*.ppm"))


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("fix a all ave/time 1 1 10 ke", "expected 'c_ID', found 'ke'"),
        ("fix a all ave/time 2 5 5 c_thermo_temp", "must fit into 5 steps"),
        ("fix a all ave/time 1 1 5 c_thermo_temp file ../a", "leads out of the folder"),
        ("fix a all ave/time 1 1 5 c_thermo_temp overwrite", "needs 'ave running'"),
        ("fix a all ave/time 1 1 5 c_b\nrun 5", "no compute 'b'"),
        (
            "compute co all com\nfix a all ave/time 1 1 5 c_co c_thermo_temp mode vector",
            "have [3, 6] values",
        ),
        ("fix a all ave/atom 1 1 5 vxx", "did you mean 'vx'?"),
        ("fix a all ave/correlate 1 5 4 ke", "expected 'c_ID', found 'ke'"),
        ("fix a all ave/correlate 2 5 5 c_thermo_temp", "must fit into 5 steps"),
        ("fix a all ave/correlate 1 9 5 c_thermo_temp", "must fit into 5 steps"),
        ("fix a all ave/correlate 1 1 5 c_thermo_temp overwrite", "needs 'ave running'"),
        ("fix a all ave/correlate 1 1 5 c_thermo_temp type all", "known: auto, upper"),
        ("fix a all ave/correlate 1 1 5 c_thermo_temp file ../a", "leads out of the folder"),
        ("fix a all ave/correlate 1 2000000 9000000 c_thermo_temp", "more than 1000000 numbers"),
        ("fix a all property/atom p scalar yes no no 1 2", "do not fit 'scalar'"),
        ("set atom 1 property/atom q 1", "no fix property/atom has 'q'"),
    ],
)
def test_mistake_names_file_and_line(tmp_path, line, message):
    script = scenes.write(tmp_path, scenes.scene(line + "\n"))
    with pytest.raises(ScriptError) as error:
        run_script(script, root=tmp_path)
    assert message in str(error.value)


TOLD = """fix p1 all particletemplate/sphere 15485863 atom_type 1 &
  density constant 2500 radius constant 0.001
fix p2 all particletemplate/sphere 15485867 atom_type 1 &
  density constant 2500 radius constant 0.003
fix dm all diam/max
variable d equal f_dm
print "${d} without a distribution" append told.txt
fix small all particledistribution/discrete 32452843 1 p1 1.0
print "${d} as it was" append told.txt
run 1
print "${d} in a run" append told.txt
fix large all particledistribution/discrete 32452867 2 p1 0.9 p2 0.1
fix dn all diam/max
variable e equal f_dn
print "${e} of the first of two" append told.txt
"""


def test_the_largest_diameter_is_that_of_the_first_distribution(tmp_path):
    told = scenes.run_minidem(tmp_path, scenes.scene(TOLD))["told.txt"]
    # Grains of 0.008 m are there; they do not count.
    assert [line.split()[0] for line in told.splitlines()] == ["0", "0", "0.002", "0.002"]


@pytest.mark.liggghts
def test_the_largest_diameter_is_that_of_liggghts(tmp_path):
    script = scenes.scene(TOLD)
    mine = scenes.run_minidem(tmp_path / "mine", script)
    assert mine["told.txt"] == scenes.run_liggghts(tmp_path / "theirs", script)["told.txt"]


RESET = """variable s equal ke(all)
variable n equal step
fix m all ave/time 2 5 20 v_s v_n file m.txt
fix h all ave/histo 2 5 20 0 1 4 vx mode vector file h.txt
fix c all ave/correlate 2 5 20 v_s v_n ave running file c.txt
run 87
reset_timestep 40
run 100
"""


def steps(text: str) -> list[str]:
    """Return the steps that a file of averages or correlations has."""
    lines = [line.split() for line in text.splitlines() if not line.startswith("#")]
    # A line of means has three words here, and what stands above correlations two; these have five.
    return [words[0] for words in lines if len(words) in (2, 3)]


def test_samples_stay_due_where_the_step_is_set_back(tmp_path):
    found = scenes.run_minidem(tmp_path, scenes.scene(RESET))
    # Seen with LIGGGHTS 3.8.0: what was due at step 88 or 92 is taken there, not from 40 on.
    assert steps(found["m.txt"]) == ["20", "40", "60", "80", "100", "120", "140"]
    assert steps(found["c.txt"]) == ["0", "20", "40", "60", "80", "100", "120", "140"]


def test_a_step_behind_the_next_sample_is_refused_before_it_is_missed(tmp_path):
    script = scenes.write(tmp_path, scenes.scene(RESET.replace("timestep 40", "timestep 90")))
    with pytest.raises(
        ScriptError, match=r"fix c \(ave/correlate\) takes its next sample at step 88"
    ):
        run_script(script, root=tmp_path)


@pytest.mark.liggghts
def test_where_the_step_is_set_back_all_files_are_those_of_liggghts(tmp_path):
    mine = scenes.run_minidem(tmp_path / "mine", scenes.scene(RESET))
    theirs = scenes.run_liggghts(tmp_path / "theirs", scenes.scene(RESET))
    assert len(theirs) == 3
    assert scenes.different(mine, theirs) == []
