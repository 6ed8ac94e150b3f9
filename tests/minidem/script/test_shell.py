"""``shell``: five words act as in LIGGGHTS, inside the case; nothing is executed."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from minidem.errors import ScriptError
from tests.minidem.script.few_particles import execute

BUILT_IN = """
shell mkdir post restart post/deep
shell mkdir post
print one file post/a.txt
shell mv post/a.txt post/b.txt
shell mv nothing post/c.txt
shell rm post nothing
shell rmdir restart nothing
shell rmdir post
shell cd post
print two file here.txt
shell mkdir inner
shell cd ..
print three file top.txt
"""
"""What LIGGGHTS does with its own functions; what the system refuses is no error."""


def tree(folder: Path) -> dict[str, str]:
    """Return all folders and files below a folder, with what is in them."""
    return {
        str(path.relative_to(folder)): path.read_text() if path.is_file() else "folder"
        for path in folder.rglob("*")
        if path.name not in ("in.script", "log.liggghts")
    }


def test_folders_and_files_are_as_liggghts_leaves_them(tmp_path):
    execute(tmp_path, BUILT_IN)
    assert tree(tmp_path) == {
        "post": "folder",
        "post/deep": "folder",
        "post/b.txt": "one\n",
        "post/here.txt": "two\n",
        "post/inner": "folder",
        "top.txt": "three\n",
    }


@pytest.mark.liggghts
@pytest.mark.skipif(shutil.which("liggghts") is None, reason="needs LIGGGHTS")
def test_liggghts_itself_leaves_the_same(tmp_path):
    ours, theirs = tmp_path / "ours", tmp_path / "theirs"
    for folder in (ours, theirs):
        folder.mkdir()
    execute(ours, BUILT_IN)
    (theirs / "in.script").write_text(BUILT_IN)
    command = ["liggghts", "-in", "in.script"]
    subprocess.run(command, cwd=theirs, check=True, capture_output=True, timeout=60)
    assert tree(ours) == tree(theirs)


def test_other_lines_are_skipped_with_one_warning_each(tmp_path):
    said: list[str] = []
    text = (
        "variable i loop 3\nlabel a\nshell touch x\nnext i\njump SELF a\n"
        "shell rm -rf /\nshell mkdir ../out\nshell putenv A=1\nshell cd nowhere\n"
    )
    case = tmp_path / "case"
    case.mkdir()
    execute(case, text, warn=said.append)
    assert [line.split(" is skipped: ")[0] for line in said] == [
        "'shell touch x'",
        "'shell rm -rf /'",
        "'shell mkdir ../out'",
        "'shell putenv A=1'",
        "'shell cd nowhere'",
    ]
    assert [path.name for path in tmp_path.iterdir()] == ["case"]
    assert tree(tmp_path / "case") == {}


def test_strict_refuses_what_would_be_skipped(tmp_path):
    with pytest.raises(ScriptError, match=r":1: 'shell touch x' is refused by --strict"):
        execute(tmp_path, "shell touch x\n", strict=True)


def test_links_are_moved_and_deleted_themselves(tmp_path):
    case = tmp_path / "case"
    case.mkdir()
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "kept").write_text("kept")
    (case / "link").symlink_to(tmp_path / "out")
    (case / "file").symlink_to(tmp_path / "out" / "kept")
    execute(case, "shell rm file\nshell rm link/kept\nshell mkdir link/new\nshell mv link other\n")
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["kept"]
    assert sorted(path.name for path in case.iterdir()) == ["in.script", "other"]
    with pytest.raises(ScriptError, match="leads out"):
        execute(case, "shell cd other\n")
