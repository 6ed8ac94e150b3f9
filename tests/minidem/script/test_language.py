"""Script language: words, variables, formulas and control flow.

Expected texts were printed by LIGGGHTS-PUBLIC 3.8.0 for the same lines.
"""

from __future__ import annotations

import codecs
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from minidem import ScriptError, run_script
from minidem.script import Hooks, Interpreter
from minidem.script.lexer import split_words, strip_comment
from tests.minidem.script.few_particles import FewParticles, execute, printed

BOXED = """units si
atom_style granular
boundary f f f
newton off
communicate single vel yes
region box block 0 1 0 1 0 1 units box
create_box 1 box
neighbor 0.01 bin
"""


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        ("-2^2", "4"),
        ("2^-1", "0.5"),
        ("2^3^2", "64"),
        ("7%3", "1"),
        ("-7%3", "-1"),
        ("!0", "1"),
        ("1-2-3", "-4"),
        ("2*-3", "-6"),
        ("1==1&&2<3||0", "1"),
        ("abs(-3)", "3"),
        ("round(-2.5)", "-2"),
        ("round(2.5)", "3"),
        ("PI", "3.141592653589793116"),
        ("exp(1)", "2.7182818284590450908"),
        ("log(2)", "0.30102999566398119802"),
        ("atan2(1,2)", "0.46364760900080609352"),
        ("1e-5", "1.0000000000000000818e-05"),
        ("1.5E+3", "1500"),
        (".5", "0.5"),
        ("stagger(100,10)", "100"),
        ("logfreq(10,5,10)", "30"),
        ("stride(5,100,10)", "25"),
        ("ramp(1,3)", "2"),
        ("vdisplace(1,2)", "11"),
        ("count(all)*2", "6"),
        ("c_rke+c_red[2]+f_mf[1]", "8.75"),
        ("x[2]", "4"),
        ("x[9]", "0"),
    ],
)
def test_formula_has_the_value_of_liggghts(tmp_path, formula, expected):
    assert printed(tmp_path, f'print "$({formula})"\n') == [expected]


def test_variable_in_a_formula_has_fifteen_digits(tmp_path):
    """LIGGGHTS passes the text of an equal-style variable on, and so loses digits."""
    text = 'variable a equal 1/3\nvariable b equal v_a*3-1\nprint "${b} $(v_a)"\n'
    assert printed(tmp_path, text) == ["-1.11022302462516e-15 0.33333333333333298176"]


def test_random_numbers_are_those_of_liggghts(tmp_path):
    text = 'print "$(random(0,1,15485863)) $(random(0,1,15485863))"\nprint "$(normal(0,1,10007))"\n'
    assert printed(tmp_path, text) == [
        "0.86316907405853271484 0.6564229130744934082",
        "-0.07343932932251691359",
    ]


def test_loop_prints_padded_numbers(tmp_path):
    text = 'variable i loop 9 11 pad\nlabel go\nprint "$i"\nnext i\njump SELF go\nprint "end"\n'
    assert printed(tmp_path, text) == ["09", "10", "11", "end"]


def test_index_given_on_the_command_line_wins(tmp_path):
    text = 'variable mu index 0.3 0.5\nprint "${mu}"\nnext mu\nprint "${mu}"\n'
    assert printed(tmp_path, text) == ["0.3", "0.5"]
    assert printed(tmp_path, text, variables={"mu": ["7", "8"]}) == ["7", "8"]


@pytest.mark.parametrize(
    ("condition", "expected"),
    [("$a > 0.3", "then"), ("$a > 2", "elif"), ("(1 == 2) || 0", "else"), ("!0 && 1", "then")],
)
def test_if_takes_the_first_branch_that_holds(tmp_path, condition, expected):
    second = "$a > 0.5" if expected == "elif" else "0"
    text = (
        "variable a equal 1\n"
        f'if "{condition}" then "print then" elif "{second}" "print elif" &\n   else "print else"\n'
    )
    assert printed(tmp_path, text) == [expected]


def test_included_file_and_jump_to_another(tmp_path):
    (tmp_path / "part").write_text("run 1\njump other\nrun 2\n")
    (tmp_path / "other").write_text("run 3\n")
    _, commands = execute(tmp_path, "include part\nrun 4\n")
    assert [(c.args, c.file, c.line) for c in commands] == [
        (("1",), "part", 1),
        (("3",), "other", 1),
        (("4",), str(tmp_path / "in.script"), 2),
    ]


def test_engine_receives_words_after_substitution(tmp_path):
    text = "variable s string 'a b'\nfix 1 all print 10 \"x ${s}\" &  \n 5 ${s} # 7\n"
    _, commands = execute(tmp_path, text)
    assert commands[0].args == ("1", "all", "print", "10", "x ${s}", "5", "a", "b")


def test_echo_repeats_lines_and_substitutions(tmp_path):
    lines: list[str] = []
    execute(tmp_path, "variable n equal 4\nrun $n # go\n", echo=lines.append)
    assert lines == ["variable n equal 4", "run $n # go", "run 4 "]


def test_print_writes_and_appends_files(tmp_path):
    text = "print one file a.txt screen no\nprint two append a.txt\n"
    assert printed(tmp_path, text) == ["two"]
    assert (tmp_path / "a.txt").read_text() == "one\ntwo\n"


def test_atom_style_variable_has_one_value_per_particle(tmp_path):
    script = tmp_path / "in.s"
    script.write_text(
        "variable two equal 2\nvariable a atom -v_two*vx*abs(vx)\nvariable c atom v_two\n"
    )
    interpreter = Interpreter(script, root=tmp_path, variables={}, context=FewParticles(), known=[])
    interpreter.run(lambda command: None)
    np.testing.assert_array_equal(interpreter.atom_values("a"), [-2.0, 2.0, -8.0])
    np.testing.assert_array_equal(interpreter.atom_values("c"), [2.0, 2.0, 2.0])
    assert interpreter.value("two") == 2.0
    assert interpreter.variable_style("a") == "atom"


def test_line_can_be_executed_during_a_run(tmp_path):
    """As ``run 10 every 5 "..."`` does."""
    script = tmp_path / "in.s"
    script.write_text("variable i loop 5\nrun 10\n")
    seen: list[str] = []
    interpreter = Interpreter(
        script,
        root=tmp_path,
        variables={},
        context=FewParticles(),
        known=["run"],
        hooks=Hooks(emit=seen.append),
    )
    interpreter.run(lambda command: interpreter.execute_line("if '$i == 1' then 'print $i'"))
    assert seen == ["1"]


def test_comment_and_quotes_are_split_like_the_liggghts_parser():
    assert strip_comment('print "it\'s" # no') == 'print "it\'s" # no'
    assert strip_comment("a#b") == "a"
    assert split_words("  a 'b c' \"d\"\t") == ["a", "b c", "d"]


@given(st.text(" \t\v\f\r\u00a0\u2003ab#&$", max_size=30))
def test_a_line_without_quotes_has_the_words_of_one_with(line):
    # Such a line is taken apart at once; blanks are C's in both.
    assert [*split_words(line), "end"] == split_words(f"{line} 'end'")


def refused_bytes(folder: Path, raw: bytes) -> str:
    path = folder / "case.in"
    path.write_bytes(raw)
    with pytest.raises(ScriptError) as caught:
        run_script(path, root=folder)
    return str(caught.value)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("timestep\N{NO-BREAK SPACE}1e-5", "U+00A0 is a sign of word processors: write a blank"),
        ("fix g all gravity 9.81 vector 0 0 \N{MINUS SIGN}1", "U+2212 is a sign of word"),
        ("print \N{LEFT DOUBLE QUOTATION MARK}a case\N{RIGHT DOUBLE QUOTATION MARK}", 'write " in'),
        ('if "2 \N{MINUS SIGN} 1" then "print x"', "U+2212 is a sign of word processors"),
        ("timestep 2,5e-5", "expected a number, found '2,5e-5'; write a point, not a comma"),
    ],
)
def test_signs_of_other_programs_are_named_with_what_belongs_there(tmp_path, line, said):
    message = refused_bytes(tmp_path, (BOXED + line + "\n").encode())
    assert message.startswith(f"{tmp_path}/case.in:9: ")
    assert said in message


def test_such_signs_in_a_comment_or_a_text_are_nobodys_business(tmp_path):
    line = 'timestep 1e-5 # half \N{MINUS SIGN}\nprint "\N{EN DASH}"\n'
    (tmp_path / "case.in").write_text(BOXED + line, encoding="utf-8")
    run_script(tmp_path / "case.in", root=tmp_path)
    for line in ("timestep x # \N{EN DASH}\n", 'print "0 \N{EN DASH} 1" scren yes\n'):
        assert "U+" not in refused_bytes(tmp_path, (BOXED + line).encode())


@pytest.mark.parametrize(
    ("raw", "said"),
    [
        (codecs.BOM_UTF8 + BOXED.encode(), "begins with a byte order mark"),
        (codecs.BOM_UTF16_LE + BOXED.encode("utf-16-le"), "is text in UTF-16"),
        (codecs.BOM_UTF16_BE + BOXED.encode("utf-16-be"), "is text in UTF-16"),
    ],
)
def test_how_an_editor_saved_a_script_is_said(tmp_path, raw, said):
    message = refused_bytes(tmp_path, raw)
    assert said in message
    assert "save it as UTF-8" in message
