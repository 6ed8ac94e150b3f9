"""Script language: what is refused, and in which words."""

from __future__ import annotations

import pytest

from minidem.errors import InputError, ScriptError
from minidem.script import EmptyContext, Interpreter, inside
from tests.minidem.script.few_particles import execute, printed


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("foo 1\n", ":1: unknown command 'foo'"),
        ("run 1\nfxi a\n", ":2: unknown command 'fxi'; did you mean 'fix'?"),
        ('if "1" then "foo 3"\n', ":1: unknown command 'foo'"),
        ("shell\n", "shell needs a command"),
        ("shell cd\n", "shell cd needs one folder"),
        ("shell cd ..\n", "leads out of the folder"),
        ("shell mv a b c\n", "shell mv needs two names"),
        ("variable a world b c\n", "there is one partition"),
        ("variable a file none\n", "cannot read 'none'"),
        ("variable a atomfile ../b\n", "leads out of the folder"),
        ("variable a uloop 2 3\n", "uloop needs N"),
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
        ('if "1" then "include a"\n', "include cannot be used within an if"),
        ('if "a == b" then "run 1"\n', "may only compare numbers"),
        ('if "1 > 0" than "run 1"\n', "if needs"),
        ("print a file ../b\n", "leads out of the folder"),
        ("print a fil b\n", "unexpected 'fil'"),
        ("next i\n", "unknown variable 'i'"),
        ("variable s string a\nnext s\n", "index or loop"),
        ("label a\njump SELF a\n", "does a loop of jumps ever end?"),
        ("include in.script\n", "levels deep"),
        ("run 1\nvariable a equal {{ amp }}  # mm\n", ":2: '{{ amp }}' is a place of a template"),
        ("{% for i in n %}\nrun 1\n", ":1: '{% for i in n %}' is a place of a template"),
    ],
)
def test_mistake_is_named_with_file_and_line(tmp_path, text, message, monkeypatch):
    monkeypatch.setattr("minidem.script.control.MAX_COMMANDS", 2000)
    with pytest.raises(ScriptError) as error:
        execute(tmp_path, text)
    assert message in str(error.value)
    assert str(error.value).startswith((str(tmp_path / "in.script"), "in.script"))


def test_braces_in_quotes_and_in_lines_that_are_skipped_are_no_template(tmp_path):
    text = 'print "{{ a }}"\njump SELF on\nrun {{ steps }}\nlabel on\n'
    assert printed(tmp_path, text) == ["{{ a }}"]


def interpreter_of_one_run(tmp_path):
    (tmp_path / "in.s").write_text("# one\nrun 1\n")
    return Interpreter(
        tmp_path / "in.s", root=tmp_path, variables={}, context=EmptyContext(), known=["run"]
    )


@pytest.mark.parametrize(
    "fault", [KeyError("a"), IndexError("b"), TypeError("c"), OverflowError(), ValueError("d")]
)
def test_fault_of_the_engine_is_not_made_a_mistake_of_the_user(tmp_path, fault):
    def execute_badly(command):
        raise fault

    with pytest.raises(type(fault)) as caught:
        interpreter_of_one_run(tmp_path).run(execute_badly)
    assert caught.value is fault


def test_mistake_in_a_word_gets_file_and_line(tmp_path):
    def refuse(command):
        msg = "one step too many"
        raise InputError(msg)

    with pytest.raises(ScriptError, match=r"in\.s:2: one step too many"):
        interpreter_of_one_run(tmp_path).run(refuse)


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


def test_symbolic_link_out_of_the_root_is_refused(tmp_path):
    root = tmp_path / "case"
    root.mkdir()
    (root / "link").symlink_to(tmp_path)
    with pytest.raises(ValueError, match="leads out"):
        inside(root, "link/secret")
    assert inside(root, "post/a.txt") == (root / "post" / "a.txt").resolve()
