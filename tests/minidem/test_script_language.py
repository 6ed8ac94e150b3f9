"""Script language: words, variables, formulas and control flow.

Expected texts were printed by LIGGGHTS-PUBLIC 3.8.0 for the same lines.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from minidem.errors import ScriptError
from minidem.script import Command, EmptyContext, Hooks, Interpreter, inside
from minidem.script.lexer import split_words, strip_comment


class FewParticles(EmptyContext):
    """Three particles at step 20 of a run from 10 to 30."""

    def thermo(self, keyword):
        """Return thermo keywords."""
        values = {"step": 20.0, "beginstep": 10.0, "endstep": 30.0, "dt": 0.5, "atoms": 3.0}
        return values[keyword]

    def group_value(self, function, args):
        """Return group functions."""
        if args[0] != "all":
            msg = f"unknown group '{args[0]}'"
            raise ValueError(msg)
        return {"count": 3.0, "mass": 6.0}[function]

    def compute_value(self, id, indices):
        """Return computes."""
        return {("rke", ()): 1.5, ("red", (2,)): 7.0}[id, indices]

    def fix_value(self, id, indices):
        """Return fixes."""
        return {("mf", (1,)): 0.25}[id, indices]

    def atom_vector(self, name):
        """Return per-particle values."""
        vectors = {"id": [3, 1, 2], "x": [0.0, 1.0, 4.0], "vx": [1.0, -1.0, 2.0]}
        return np.array(vectors[name], dtype=np.float64)


def execute(tmp_path: Path, text: str, known=("run", "fix", "log"), **options):
    """Run a script; return printed lines and the commands that reached the engine."""
    script = tmp_path / "in.script"
    script.write_text(text)
    printed: list[str] = []
    commands: list[Command] = []
    interpreter = Interpreter(
        script,
        root=tmp_path,
        variables=options.pop("variables", {}),
        context=options.pop("context", FewParticles()),
        known=known,
        hooks=Hooks(emit=printed.append, **options),
    )
    interpreter.check()
    interpreter.run(commands.append)
    return printed, commands


def printed(tmp_path: Path, text: str, **options) -> list[str]:
    return execute(tmp_path, text, **options)[0]


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


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("foo 1\n", ":1: unknown command 'foo'"),
        ("run 1\nfxi a\n", ":2: unknown command 'fxi'; did you mean 'fix'?"),
        ('if "1" then "foo 3"\n', ":1: unknown command 'foo'"),
        ("shell rm -rf /\n", "'shell' is refused"),
        ("variable a getenv HOME\n", "style 'getenv' is refused"),
        ("variable a eqal 3\n", "did you mean 'equal'?"),
        ("variable a equal 1\nvariable a string b\n", "cannot become string"),
        ("print $b\n", "unknown variable 'b'"),
        ('print "${b}"\n', ":1: unknown variable 'b'"),
        ("variable mass equal 1\nprint ${mas}\n", "did you mean 'mass'?"),
        ('print "unclosed\n', "opened but not closed"),
        ("run '1'2\n", "must be followed by a blank"),
        ("print $(1+)\n", "expected a number, a name or '('"),
        ("print $(1/0)\n", "division by zero"),
        ("print $(sqrt(0-1))\n", "square root of a negative"),
        ("print $(sin(1,2))\n", "takes 1 argument"),
        ("print $(random(0,1,12))\n", "must be a prime"),
        ("print $(__import__)\n", "expected a number, a name"),
        ("print $(foo)\n", "'foo' is not known in a formula"),
        ("print $(count(nobody))\n", "unknown group 'nobody'"),
        ("print $(x)\n", "one value per particle"),
        ("variable a equal v_b\nvariable b equal v_a\nprint $a\n", "in a circle"),
        ("jump SELF nowhere\n", "label 'nowhere' is not in the script"),
        ("include ../outside\n", "leads out of the folder"),
        ("include /etc/passwd\n", "is an absolute path"),
        ("include missing\n", ":1: cannot open input script 'missing'"),
        ('if "1" then "include a"\n', "cannot open input script 'a'"),
        ('if "a == b" then "run 1"\n', "may only compare numbers"),
        ('if "1 > 0" than "run 1"\n', "if needs"),
        ("print a file ../b\n", "leads out of the folder"),
        ("print a fil b\n", "unexpected 'fil'"),
        ("next i\n", "unknown variable 'i'"),
        ("variable s string a\nnext s\n", "index or loop"),
        ("label a\njump SELF a\n", "does a loop of jumps ever end?"),
        ("include in.script\n", "levels deep"),
    ],
)
def test_mistake_is_named_with_file_and_line(tmp_path, text, message, monkeypatch):
    monkeypatch.setattr("minidem.script.control.MAX_COMMANDS", 2000)
    with pytest.raises(ScriptError) as error:
        execute(tmp_path, text)
    assert message in str(error.value)
    assert str(error.value).startswith((str(tmp_path / "in.script"), "in.script"))


@pytest.mark.parametrize("error", [KeyError("a"), IndexError("b"), TypeError("c"), OverflowError()])
def test_what_a_handler_did_not_foresee_is_no_traceback(tmp_path, error):
    def execute_badly(command):
        raise error

    (tmp_path / "in.s").write_text("# one\nrun 1\n")
    interpreter = Interpreter(
        tmp_path / "in.s", root=tmp_path, variables={}, context=EmptyContext(), known=["run"]
    )
    with pytest.raises(ScriptError, match=r"in\.s:2: 'run 1' cannot be carried out"):
        interpreter.run(execute_badly)


def test_nested_variables_cannot_explode(tmp_path):
    """Each of 30 variables uses the one before twice: a thousand million evaluations."""
    lines = ["variable v0 equal 1"]
    lines += [f"variable v{i} equal v_v{i - 1}+v_v{i - 1}" for i in range(1, 30)]
    with pytest.raises(ScriptError, match="operations"):
        execute(tmp_path, "\n".join([*lines, "print ${v29}", ""]))


def test_growing_string_is_stopped(tmp_path):
    text = "variable s string aaaaaaaaaaaaaaaa\nlabel a\nvariable s string $s$s\njump SELF a\n"
    with pytest.raises(ScriptError, match="longer than"):
        execute(tmp_path, text)


def test_command_after_quit_is_neither_checked_nor_run(tmp_path):
    assert printed(tmp_path, 'print "a"\nquit\nunheard of\n') == ["a"]


def test_style_hook_sees_commands_before_the_first_is_run(tmp_path):
    seen: list[str] = []
    with pytest.raises(ScriptError, match="missing"):
        execute(
            tmp_path,
            "run 1\nfix a all b\ninclude missing\n",
            check_style=lambda command: seen.append(command.name),
        )
    assert seen == ["run", "fix"]


def test_comment_and_quotes_are_split_like_the_liggghts_parser():
    assert strip_comment('print "it\'s" # no') == 'print "it\'s" # no'
    assert strip_comment("a#b") == "a"
    assert split_words("  a 'b c' \"d\"\t") == ["a", "b c", "d"]


def test_symbolic_link_out_of_the_root_is_refused(tmp_path):
    root = tmp_path / "case"
    root.mkdir()
    (root / "link").symlink_to(tmp_path)
    with pytest.raises(ValueError, match="leads out"):
        inside(root, "link/secret")
    assert inside(root, "post/a.txt") == (root / "post" / "a.txt").resolve()
