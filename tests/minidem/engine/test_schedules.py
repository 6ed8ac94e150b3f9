"""Steps that variables name: of thermo output, dumps and restart files, as in LIGGGHTS 3.8.0."""

from __future__ import annotations

import shutil
import subprocess

import pytest

from minidem import run_script
from minidem.errors import ScriptError
from tests.minidem.script.test_acceptance import SCRIPT

HEAD = (
    SCRIPT.replace("run 3\n", "thermo_style custom step ke\n")
    + """
variable t equal logfreq(10,3,10)
variable s equal stride(20,400,30)
variable g equal stagger(100,7)
variable far equal step+1000
"""
)
RUNS = """dump d1 all custom 1000 d1.*.dump id x
dump_modify d1 every v_s
dump d2 all custom 1000 d2.*.dump id x
dump_modify d2 every v_g first yes
thermo v_t
restart v_g r.*
run 333
thermo 100
run 150
thermo v_far
run 77
thermo v_s
run 40
dump_modify d2 every 50
restart v_s a.rst b.rst
run 100
restart 0
thermo v_far
run 0
run 1500
"""
LINES = [0, 10, 20, 30, 100, 200, 300, 333, 333, 483, 560, 600, 700, 700, 1700, 2200]
FILES = {
    "d1": [20, 50, 80, *range(110, 381, 30)],
    "d2": [0, *sorted([*range(100, 601, 100), *range(7, 508, 100)]), *range(650, 2201, 50)],
    "r": sorted([*range(100, 601, 100), *range(7, 608, 100), 700]),
}
"""Printed and written by LIGGGHTS-PUBLIC 3.8.0 (test_liggghts_itself_does_the_same)."""


def written(folder):
    """Return the steps of thermo lines and of files by the beginning of their names."""
    steps = []
    for line in (folder / "log.liggghts").read_text(errors="replace").splitlines():
        words = line.split()
        if len(words) == 2 and words[0].isdigit():
            steps.append(int(words[0]))
    found = {name: [] for name in FILES}
    for path in folder.iterdir():
        name, _, rest = path.name.partition(".")
        if name in found:
            found[name].append(int(rest.removesuffix(".dump")))
    return steps, {name: sorted(found[name]) for name in found}


def test_variables_say_when_to_write(tmp_path):
    script = tmp_path / "in.script"
    script.write_text(HEAD + RUNS)
    run_script(script, root=tmp_path)
    assert written(tmp_path) == (LINES, FILES)
    log = (tmp_path / "log.liggghts").read_text()
    assert "thermo 100 has no effect, as in LIGGGHTS 3.8.0: variable 't' says" in log


@pytest.mark.liggghts
def test_liggghts_itself_does_the_same(tmp_path):
    (tmp_path / "in.script").write_text(HEAD + RUNS)
    program = str(shutil.which("liggghts"))
    subprocess.run([program, "-in", "in.script"], cwd=tmp_path, check=True, capture_output=True)
    assert written(tmp_path) == (LINES, FILES)


def test_files_in_turns_come_when_a_variable_says(tmp_path):
    script = tmp_path / "in.script"
    script.write_text(HEAD + "restart v_s a.rst b.rst\nrun 60\n")
    run_script(script, root=tmp_path)
    assert (tmp_path / "a.rst").stat().st_mtime_ns < (tmp_path / "b.rst").stat().st_mtime_ns


@pytest.mark.parametrize(
    "line",
    ["thermo v_past", "dump d all xyz 10 a.xyz\ndump_modify d every v_past", "restart v_past r"],
)
def test_a_step_that_is_over_is_refused(tmp_path, line):
    script = tmp_path / "in.script"
    script.write_text(HEAD + f"variable past equal 30\n{line}\nrun 100\n")
    with pytest.raises(ScriptError) as caught:
        run_script(script, root=tmp_path)
    place = "dump_modify d every" if "dump" in line else line.split()[0]
    assert f"{place}: variable 'past' gives step 30, which is not after the present one, 30" in str(
        caught.value
    )
