"""The words that only minidem understands: one table, refused by --strict, bad values named."""

from __future__ import annotations

import pytest

from minidem import ScriptError, run_script
from minidem.cli import main
from minidem.contact.extensions import EXTENSIONS, SETTINGS
from minidem.kernels.contact.records import Switches
from minidem.world.fix import FIXES


def test_table_names_what_the_code_understands():
    assert {Switches._fields[at]: word for word, at in SETTINGS.items()} == {
        "static_friction": "staticFriction",
        "velocity_restitution": "velocityRestitution",
        "restitution_scatter": "restitutionScatter",
        "tangential_stiffness": "tangentialStiffness",
    }
    assert {*EXTENSIONS} - {*SETTINGS} <= {*FIXES}


STRICT = [
    ("fix air all drag/sphere density 1 viscosity 1", "drag/sphere"),
    ("pair_style gran model hertz tangential history staticFriction on", "staticFriction"),
    (
        "fix w all wall/gran model hertz primitive type 1 zplane 0 velocityRestitution on",
        "velocityRestitution",
    ),
    ("pair_style gran model hertz tangential history restitutionScatter on", "restitutionScatter"),
    ("pair_style gran model hertz tangentialStiffness on", "tangentialStiffness"),
]


@pytest.mark.parametrize(("line", "word"), STRICT)
def test_strict_refuses_an_extension_before_the_first_command(tmp_path, line, word):
    (tmp_path / "in.s").write_text(f"units si\n{line}\n")
    with pytest.raises(ScriptError) as error:
        run_script(tmp_path / "in.s", root=tmp_path, strict=True)
    assert error.value.line == 2
    assert f"'{word}' is an extension of minidem that LIGGGHTS 3.8.0 does not have" in str(
        error.value
    )
    assert "--strict" in str(error.value)


def test_strict_sees_a_word_that_a_variable_holds(tmp_path):
    (tmp_path / "in.s").write_text(
        "variable style string drag/sphere\nfix air all ${style} density 1 viscosity 1\n"
    )
    with pytest.raises(ScriptError, match=r"in\.s:2: 'drag/sphere' is an extension"):
        run_script(tmp_path / "in.s", root=tmp_path, strict=True)


@pytest.mark.parametrize("word", ["-strict", "--strict"])
def test_the_command_line_knows_strict(tmp_path, monkeypatch, capsys, word):
    (tmp_path / "in.s").write_text("fix air all drag/sphere density 1 viscosity 1\n")
    monkeypatch.chdir(tmp_path)
    assert main(["-in", "in.s", word]) == 2
    assert "in.s:1: 'drag/sphere' is an extension of minidem" in capsys.readouterr().err


BAD = [
    ("drag/sphere density 1", "drag/sphere needs 'viscosity VALUE'"),
    ("drag/sphere density 0 viscosity 1", "drag/sphere needs 'density VALUE' with a value above"),
    ("drag/sphere density 1 viscosity 1 factor -1", "factor -1 is negative"),
    ("drag/sphere densty 1", "unknown fix drag/sphere keyword 'densty'; did you mean 'density'?"),
    ("drag/sphere velocity 1 2", "too few words; usage: drag/sphere ... velocity VALUE"),
]


@pytest.mark.parametrize(("words", "message"), BAD)
def test_bad_drag_is_named(tmp_path, words, message):
    box = "region b block 0 1 0 1 0 1\ncreate_box 1 b\n"
    (tmp_path / "in.s").write_text(box + f"fix air all {words}\n")
    with pytest.raises(ScriptError) as error:
        run_script(tmp_path / "in.s", root=tmp_path)
    assert message in str(error.value)
    assert error.value.line == 3
