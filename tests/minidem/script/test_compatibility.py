"""The page of what is understood is that of the code; gaps are told from typing mistakes."""

from __future__ import annotations

import pytest

from minidem import run_script
from minidem.compatibility import main, page
from minidem.errors import ScriptError
from tests.paths import ROOT

PAGE = ROOT / "docs" / "compatibility.md"


def test_page_is_that_of_the_code():
    assert PAGE.read_text(encoding="utf-8") == page(), (
        "the registry changed; run: python -m minidem.compatibility docs/compatibility.md"
    )


def test_page_is_written_to_the_named_file(tmp_path):
    assert main([str(tmp_path / "page.md")]) == 0
    assert (tmp_path / "page.md").read_text().startswith("# What minidem understands")


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("minimize 1 1 1 1", ":1: command 'minimize' exists in LIGGGHTS but not in minidem"),
        ("fix a all heat/gran", ":1: fix 'heat/gran' exists in LIGGGHTS but not in minidem"),
        ("compute a all cna/atom", ":1: compute 'cna/atom' exists in LIGGGHTS but not in minidem"),
        ("dump a all dcd 1 b", ":1: dump 'dcd' exists in LIGGGHTS but not in minidem"),
        ("fix a all wall/grann", ":1: unknown fix 'wall/grann'; did you mean 'wall/gran'?"),
        ("dunp a all image 1 b", ":1: unknown command 'dunp'; did you mean 'dump'?"),
    ],
)
def test_gap_and_typing_mistake_read_differently(tmp_path, line, message):
    script = tmp_path / "in.s"
    script.write_text(line + "\n")
    with pytest.raises(ScriptError) as error:
        run_script(script, root=tmp_path)
    assert message in str(error.value)
