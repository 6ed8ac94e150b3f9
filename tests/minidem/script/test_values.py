"""Variables with values from files, styles for partitions, and numbers that LIGGGHTS cuts."""

from __future__ import annotations

import shutil
import subprocess

import numpy as np
import pytest

from minidem import ScriptError, run_script
from minidem.script import Interpreter
from minidem.words import Words, leading_numbers
from tests.minidem.script.few_particles import FewParticles, execute, printed
from tests.minidem.script.test_acceptance import POUR, SCRIPT, after

FILES = {"vals.txt": "# comment\nalpha 1 # c\n\n beta \r\n7e-3\t8\n"}
# Printed by LIGGGHTS-PUBLIC 3.8.0 for the same lines.
PRINTS = {
    "file": (
        'variable f file vals.txt\nprint "<$f>"\nnext f\nprint "<$f>"\nnext f\nprint "<$f>"\n'
        'variable f file other\nprint "<$f>"\n',
        ["<alpha>", "< beta>", "<7e-3>", "<7e-3>"],
    ),
    "two at once": (
        "variable a index 1 2 3\nvariable b index x y z\nvariable n loop 3\nlabel l\n"
        'print "$a $b $n"\nnext a b\nnext n\njump SELF l\nprint "end"\n',
        ["1 x 1", "2 y 2", "3 z 3", "end"],
    ),
    "to the end of the file": (
        'label l\nvariable f file vals.txt\nprint "$f"\nnext f\njump SELF l\nprint "end"\n',
        ["alpha", " beta", "7e-3", "end"],
    ),
    "partitions": (
        "variable w world aa\nvariable u universe a b c\nvariable l uloop 3 pad\n"
        'print "$w $u $l"\nnext u\nprint "$u"\n',
        ["aa a 1", "b"],
    ),
    "nested $()": (
        'variable a equal 2\nprint "$(v_a*(3+(v_a-1)*2)) $(-(-(v_a)))"\nvariable x index "a b"\n'
        'print "${x}|"\nprint \'"$(1+1)"\'\n',
        ["10 2", "a b|", '"$(1+1)"'],
    ),
    "if": (
        'variable a equal 2\nif "(${a} > 1) && (${a} < 3)" then "print yes" else "print no"\n'
        'if "${a} == 3 || ${a} == 2" then "print yes"\nif "!(${a} == 2)" then "print bad" &\n'
        '  elif "${a} >= 2" "print elif" "print second" else "print no"\n',
        ["yes", "yes", "elif", "second"],
    ),
    "quotes within quotes": (
        "variable s equal 5\nvariable t string \"a 'b' $s\"\nvariable s equal 6\n"
        'print \'OUT ${t}\'\nif "1" then "print \'one\'" "variable s equal $s*2" "print \'$s\'"\n'
        "print \"$s it's $s '$s' $s\"\n",
        ["OUT a 'b' $s", "one", "12", "12 it's $s '12' $s"],
    ),
    "tabs and Windows line ends": (
        '\tvariable\ta\tequal\t1+1\t\r\nprint\t"$a"\t# said\r\nprint &\r\n  "b &\r\nc"\r\n',
        ["2", "b c"],
    ),
    "loops padded and from below zero": (
        "variable b loop 8 10 pad\nprint $b\nnext b\nprint $b\nvariable c loop -2 1\nprint $c\n",
        ["08", "09", "-2"],
    ),
}


@pytest.mark.parametrize("name", PRINTS)
def test_lines_print_what_liggghts_prints(tmp_path, name):
    write_files(tmp_path)
    text, expected = PRINTS[name]
    assert printed(tmp_path, text) == expected


@pytest.mark.liggghts
@pytest.mark.skipif(shutil.which("liggghts") is None, reason="needs LIGGGHTS")
@pytest.mark.parametrize("name", PRINTS)
def test_liggghts_itself_prints_the_same(tmp_path, name):
    write_files(tmp_path)
    text, expected = PRINTS[name]
    (tmp_path / "in.s").write_bytes(text.encode())
    done = subprocess.run(
        ["liggghts", "-in", "in.s", "-echo", "none"],
        cwd=tmp_path, check=False, capture_output=True, timeout=60,
    )  # fmt: skip
    said = done.stdout.decode(errors="replace").splitlines()
    lines = [one for one in said if not one.startswith(("LIGGGHTS (", "Total", "Increment"))]
    assert [one.rstrip() for one in lines if one][: len(expected)] == expected


def write_files(folder):
    for name, text in FILES.items():
        (folder / name).write_text(text)


def test_values_by_particle_come_from_a_file(tmp_path):
    (tmp_path / "t.txt").write_text("# two sets\n2\n2 0.5\n3 -1e3 more\n\n1\n1 7\n")
    (tmp_path / "in.script").write_text("variable t atomfile t.txt\nvariable u atom v_t*2\nrun 1\n")
    interpreter = Interpreter(
        tmp_path / "in.script", root=tmp_path, variables={}, context=FewParticles(), known=["run"]
    )
    interpreter.run(lambda command: None)
    np.testing.assert_array_equal(interpreter.atom_values("t"), [-1000.0, 0.0, 0.5])
    np.testing.assert_array_equal(interpreter.atom_values("u"), [-2000.0, 0.0, 1.0])
    interpreter.execute_line("next t")
    np.testing.assert_array_equal(interpreter.atom_values("t"), [0.0, 7.0, 0.0])
    interpreter.execute_line("next t")
    assert interpreter.variable_style("t") is None


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("", "no values"),
        ("x\n", "expected a number of lines"),
        ("3\n1 2\n", "expected a number of lines"),
        ("99999999999999999999\n1 2\n", "expected a number of lines"),
        ("1\n1\n", "expected a particle's id"),
        ("1\none 2\n", "expected a particle's id"),
    ],
)
def test_file_that_is_none_is_refused(tmp_path, content, message):
    (tmp_path / "t.txt").write_text(content)
    with pytest.raises(ScriptError, match=message):
        execute(tmp_path, "variable t atomfile t.txt\n")


def test_environment_is_not_read(tmp_path, monkeypatch):
    monkeypatch.setenv("SECRET", "password")
    said: list[str] = []
    text = 'variable s getenv SECRET\nprint "<$s>"\n'
    assert printed(tmp_path, text, warn=said.append) == ["<>"]
    assert "variable s is empty" in said[0]
    assert "-var SECRET VALUE" in said[0]
    assert printed(tmp_path, text, variables={"SECRET": ["a"]}) == ["<a>"]
    assert printed(tmp_path, text, variables={"s": ["b"]}) == ["<b>"]


# -- numbers ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("word", "loose", "value"),
    [
        ("4.05/2", True, 4.05),
        ("-1e-3*v", True, -1e-3),
        ("2mm", True, 2.0),
        (".0.5", False, 0.0),
        ("-1-2", False, -1.0),
        ("3e", False, 3.0),
        ("4.05/2", False, None),
        ("e5", True, None),
        ("nan", True, None),
        ("1e999", True, None),
        ("", True, None),
    ],
)
def test_number_is_read_as_far_as_liggghts_reads_it(word, loose, value):
    cut: list[tuple[str, str]] = []
    with leading_numbers(lambda *both: cut.append(both), loose=loose):
        if value is None:
            with pytest.raises(ValueError, match="expected a number"):
                Words([word], "run").number()
            return
        assert Words([word], "run").number() == value
    assert [first for first, _ in cut] == [word]


@pytest.mark.parametrize(
    ("word", "value"),
    [("300000/100", 300000), ("5.", 5), ("5.00", 5), ("3.7", 3), ("33.3333333333", 33),
     ("1e5", None), ("1.5e5", None), ("12e5", None), ("x", None), ("9" * 30 + "/2", None)],
)  # fmt: skip
def test_whole_number_is_read_as_far_as_it_is_meant(word, value):
    with leading_numbers(lambda *both: None, loose=True):
        if value is not None:
            assert Words([word], "run").integer() == value
            return
        with pytest.raises(ValueError, match="expected a whole number"):
            Words([word], "run").integer()


def test_cut_numbers_run_with_a_warning(tmp_path):
    pour = POUR.format(seed=32452843, target="particles_in_region 5/2")
    text = after(pour.replace("0 0 -1", "0 0 -1/9")).replace("run 3", "run 4/2\nrun 2.9")
    (tmp_path / "in.s").write_text(text)
    assert run_script(tmp_path / "in.s", root=tmp_path).steps == 6
    log = (tmp_path / "log.liggghts").read_text()
    for word, read in (("5/2", "5"), ("-1/9", "-1"), ("4/2", "4"), ("2.9", "2")):
        assert log.count(f"'{word}' is read as {read}, as LIGGGHTS does") == 1
    assert log.index("'4/2' is read") < log.index("Setting up run")


@pytest.mark.parametrize(("target", "count"), [("1e1", 1), ("3.9", 3), ("+2", 2)])
def test_whole_numbers_of_an_insertion_are_those_of_liggghts(tmp_path, target, count):
    """LIGGGHTS reads their leading digits, for a power of ten, too."""
    pour = POUR.format(seed="32452843.0", target=f"particles_in_region {target}")
    (tmp_path / "in.s").write_text(after(pour))
    (tmp_path / "in.0").write_text(SCRIPT)
    before = run_script(tmp_path / "in.0", root=tmp_path).particles
    assert run_script(tmp_path / "in.s", root=tmp_path).particles == before + count


def test_number_of_values_counts_when_a_run_starts(tmp_path):
    text = SCRIPT.replace("fix m3", "fix m2b all property/global unused peratomtype 1 2\nfix m3")
    (tmp_path / "in.s").write_text(text)
    with pytest.raises(ScriptError, match=r"in\.s:26: .*Length not correct for variable unused"):
        run_script(tmp_path / "in.s", root=tmp_path)
    (tmp_path / "in.s").write_text(text.replace("run 3", "unfix m2b\nrun 3"))
    assert run_script(tmp_path / "in.s", root=tmp_path).steps == 3


# -- functions of elements, groups and regions -----------------------------------------------------

FUNCTIONS = """region low block 0 0.1 0 0.0505 0 0.1 units box
group two id 2
velocity all ramp vx 1 3 y 0.05 0.0578
velocity two ramp vz 0.5 1 x 0 0.1 sum yes units box
velocity two set NULL 0.25 NULL sum yes
lattice sc 2.0
velocity two set 0.1 NULL NULL sum yes units lattice
compute te all temp
compute h all rdf 4
variable m atom gmask(two)+10*rmask(low)+100*grmask(all,low)
variable a equal sum(c_te)-c_te[1]-c_te[2]-c_te[3]-c_te[4]-c_te[5]-c_te[6]
variable b equal max(c_h[1])-c_h[4][1]+min(c_h[1])-c_h[1][1]
variable c equal trap(c_h[1])/c_h[4][1]
variable d equal ave(c_h[1])/c_h[4][1]
dump d all custom 1 d*.dump id vx vy vz v_m
dump_modify d sort id format "%d %.12g %.12g %.12g %g"
fix p all print 1 "${a} ${b} ${c} ${d}" file p.txt
"""


def test_functions_and_velocities_are_what_their_words_say(tmp_path):
    (tmp_path / "in.s").write_text(after(FUNCTIONS).replace("run 3", "run 1"))
    run_script(tmp_path / "in.s", root=tmp_path)
    rows = np.loadtxt(tmp_path / "d0.dump", skiprows=9)
    np.testing.assert_allclose(rows[:, 4], [110.0, 1.0])
    np.testing.assert_allclose(rows[0, 1:4], [1.0, 0.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(rows[1, 1:4], [2.0 + 0.2, 0.25, 0.75], atol=1e-12)
    values = [float(word) for word in (tmp_path / "p.txt").read_text().splitlines()[-1].split()]
    # bins of the distribution have their middle at 1/7, 3/7, 5/7 and 1 times that of the last
    np.testing.assert_allclose(values[:2], 0.0, atol=1e-12)
    np.testing.assert_allclose(values[2:], [12.0 / 7.0, 4.0 / 7.0], rtol=1e-12)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("variable a equal gmask(all)\nprint ${a}", "use a variable of style atom"),
        ("variable a equal sum(x)\nprint ${a}", "expected c_ID or f_ID"),
        ("variable a equal sum(c_q)\nrun 1\nprint ${a}", "c_q"),
        ("variable a equal grmask(all)\nprint ${a}", "takes 2 argument(s), got 1"),
        ("variable a atom rmask(q)\ndump d all custom 1 d id v_a\nrun 1", "unknown region 'q'"),
        ("variable a atom gmask(q)\ndump d all custom 1 d id v_a\nrun 1", "find group 'q'"),
        ("velocity all ramp vx 0 1 y 0 0", "both coordinates are 0"),
        ("velocity all ramp fx 0 1 y 0 1", "known: vx, vy, vz"),
        ("velocity all set 0 0 0 sum maybe", "known: yes, no"),
        ("velocity all create 300 12345", "unknown velocity style 'create'"),
    ],
)
def test_functions_and_velocities_that_are_wrong_are_named(tmp_path, line, message):
    (tmp_path / "in.s").write_text(after(line))
    with pytest.raises(ScriptError) as error:
        run_script(tmp_path / "in.s", root=tmp_path)
    assert message in str(error.value)
