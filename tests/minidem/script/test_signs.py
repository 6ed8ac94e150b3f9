"""What word processors, spreadsheets and editors make of a script is named with its remedy."""

from __future__ import annotations

import codecs
from pathlib import Path

import pytest

from minidem import ScriptError, run_script

HEAD = """units si
atom_style granular
boundary f f f
newton off
communicate single vel yes
region box block 0 1 0 1 0 1 units box
create_box 1 box
neighbor 0.01 bin
"""


def refused(folder: Path, raw: bytes) -> str:
    path = folder / "case.in"
    path.write_bytes(raw)
    with pytest.raises(ScriptError) as caught:
        run_script(path, root=folder)
    return str(caught.value)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("timestep\N{NO-BREAK SPACE}1e-5", "U+00A0, a sign of word processors: write a blank in"),
        ("fix g all gravity 9.81 vector 0 0 \N{MINUS SIGN}1", "U+2212, a sign of word processors"),
        ("print \N{LEFT DOUBLE QUOTATION MARK}a case\N{RIGHT DOUBLE QUOTATION MARK}", 'write " in'),
        ("timestep 2,5e-5", "expected a number, found '2,5e-5'; write a point, not a comma"),
    ],
)
def test_signs_of_other_programs_are_named_with_what_belongs_there(tmp_path, line, said):
    message = refused(tmp_path, (HEAD + line + "\n").encode())
    assert message.startswith(f"{tmp_path}/case.in:9: ")
    assert said in message


def test_such_signs_in_a_comment_or_a_text_are_nobodys_business(tmp_path):
    line = 'timestep 1e-5 # half \N{MINUS SIGN}\nprint "\N{EN DASH}"\n'
    (tmp_path / "case.in").write_text(HEAD + line, encoding="utf-8")
    run_script(tmp_path / "case.in", root=tmp_path)
    assert "U+" not in refused(tmp_path, (HEAD + "timestep x # \N{EN DASH}\n").encode())


@pytest.mark.parametrize(
    ("raw", "said"),
    [
        (codecs.BOM_UTF8 + HEAD.encode(), "begins with a byte order mark"),
        (codecs.BOM_UTF16_LE + HEAD.encode("utf-16-le"), "is text in UTF-16"),
        (codecs.BOM_UTF16_BE + HEAD.encode("utf-16-be"), "is text in UTF-16"),
    ],
)
def test_how_an_editor_saved_a_script_is_said(tmp_path, raw, said):
    message = refused(tmp_path, raw)
    assert said in message
    assert "save it as UTF-8" in message
