"""Means in bins of space, held against what LIGGGHTS writes."""

from __future__ import annotations

import pytest

from minidem import run_script
from minidem.errors import ScriptError
from tests.minidem.output import scenes

HEAD = scenes.HEAD.replace("boundary f f m", "boundary f f f")
LINES = """group odd type 1
compute ka all ke/atom
region rr block -0.02 0.05 -0.2 0.2 -0.1 0.1 units box
fix a1 all ave/spatial 2 5 20 z lower 0.01 vx density/number density/mass c_ka &
 file a1.txt
fix a2 odd ave/spatial 10 2 20 x center 0.05 y 0.013 0.07 vz density/mass &
 norm sample file a2.txt
fix a3 all ave/spatial 10 1 20 x 0.5 0.25 y lower 0.5 z upper 0.3 &
 fz units reduced ave running overwrite file a3.txt
fix a4 all ave/spatial 10 1 20 x lower 0.04 c_ka density/number ave window 3 &
 region rr file a4.txt write_ts no title1 "# hi"
fix a5 all ave/spatial 10 2 20 z 0.3 0.04 vx ave running file a5.txt
fix a6 all ave/spatial 10 2 20 z -0.3 0.04 vx norm sample ave running file a6.txt
run 200
"""


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Return the files that minidem writes."""
    return scenes.run_minidem(tmp_path_factory.mktemp("mine"), scenes.scene(LINES, HEAD))


def test_bins_are_those_of_liggghts(files):
    for name in ("a4.txt", "a5.txt"):
        stored = (scenes.STORED / f"spatial_{name}").read_text()
        assert scenes.alike(files[name], stored, rtol=2e-5), name  # six digits are in the files


@pytest.mark.liggghts
def test_all_bins_are_those_of_liggghts(files, tmp_path):
    theirs = scenes.run_liggghts(tmp_path, scenes.scene(LINES, HEAD))
    assert len(theirs) == 6
    assert scenes.different(files, theirs) == []


# Three grains, the first through a periodic face, and the lines that LIGGGHTS 3.8.0 writes.
GRAINS = """create_atoms 2 single 0.049 0 0
create_atoms 1 single 0.0005 0 0.0299
create_atoms 1 single -0.03 0 0.0199
set group all diameter 0.01 density 2500
set atom 1 diameter 0.012 vx 100
set atom 2 vx 0.1 vz -0.2
fix nve all nve/sphere
fix s all store/state 5 x xu zu com yes
fix t all check/timestep/gran 10 0.1 0.1 vmax 140.0 warn no
fix a all ave/spatial 5 2 10 x lower 0.02 z lower 0.03 vx units box
compute r all reduce sum f_s[1] f_s[2] f_s[3]
thermo_style custom step c_r[1] c_r[2] c_r[3] f_a[2][1] f_a[13][2] f_a[13][3] f_a[13][4] &
 f_a[99][2] f_t[1] f_t[2] f_t[3]
thermo_modify format float %.10g
thermo 10
run 20
"""
STATED = [
    "0 0.0195 -0.02489806867 0.009724892704 -0.04 0.015 0 0 0 0 0 0",
    "10 -0.07049 -0.02880169528 0.009720987124 -0.04 0.015 1 0.1 0 0.01946730212 0.01887906597 1.4",
    "20 -0.06048 -0.03270532189 0.009717081545 -0.04 0.015 1 0.1 0 0.01946730212 0.01887906597 1.4",
]


def test_values_asked_for_in_a_run_are_those_of_liggghts(tmp_path):
    script = scenes.write(tmp_path, _three())
    run_script(script, root=tmp_path)
    log = (tmp_path / "log.liggghts").read_text()
    rows = [" ".join(line.split()) for line in log.splitlines()]
    assert [row for row in rows if row in STATED] == STATED


def _three() -> str:
    text = HEAD.replace("boundary f f f", "boundary p f f")
    text = text.replace("-0.2 0.2 -0.2 0.2 -0.1 0.2", "-0.05 0.05 -0.05 0.05 -0.06 0.08")
    materials, _, _ = text.partition("fix grav ")
    return materials + GRAINS


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("z lower 1e-9 vx", "more than 1000000"),
        ("z lower 0.1 z lower 0.1 vx", "direction z comes twice"),
        ("z lower 0.1 density/mas", "did you mean 'density/mass'?"),
        ("z middle 0.1 vx", "expected a number"),
        ("z lower 0 vx", "above zero"),
        ("z lower 0.1 vx region r", "unknown region 'r'"),
        ("z lower 0.1 vx overwrite", "needs 'ave running'"),
    ],
)
def test_mistake_names_file_and_line(tmp_path, line, message):
    text = scenes.scene(f"fix a all ave/spatial 1 1 10 {line}\n")
    with pytest.raises(ScriptError) as error:
        run_script(scenes.write(tmp_path, text), root=tmp_path)
    assert message in str(error.value)
