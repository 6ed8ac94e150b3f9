"""``restart N FILE1 FILE2``: two files in turns, over all runs of a script."""

from __future__ import annotations

import shutil
import subprocess

import pytest

from minidem import run_script
from tests.minidem.script.test_acceptance import SCRIPT

WRITE = SCRIPT.replace(
    "run 3\n", "restart 2 post/a b\nrun 3\nrestart 3 single\nrun 7\nrestart 0\nrun 10\n"
)
READ = """atom_style granular
newton off
communicate single vel yes
read_restart {file}
print "step $(step)" file {file}.txt
"""
STEPS = {"post/a": 10, "b": 8, "single.6": 6, "single.9": 9}
"""Files that LIGGGHTS-PUBLIC 3.8.0 writes, and their steps."""


def written(folder) -> set[str]:
    """Return the names of all restart files."""
    found = {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}
    return {name for name in found if not name.startswith(("in", "log"))}


def test_files_are_written_in_turns(tmp_path):
    (tmp_path / "in.s").write_text(WRITE)
    run_script(tmp_path / "in.s", root=tmp_path)
    assert written(tmp_path) == set(STEPS)
    for file, step in STEPS.items():
        (tmp_path / "in.r").write_text(READ.format(file=file))
        run_script(tmp_path / "in.r", root=tmp_path, log=None)
        assert (tmp_path / f"{file}.txt").read_text() == f"step {step}\n"


@pytest.mark.liggghts
@pytest.mark.skipif(shutil.which("liggghts") is None, reason="needs LIGGGHTS")
def test_liggghts_itself_writes_the_same_files(tmp_path):
    (tmp_path / "in.s").write_text(WRITE)
    (tmp_path / "post").mkdir()  # LIGGGHTS does not make it
    for name in ("in.s", *STEPS):
        if name in STEPS:
            (tmp_path / "in.r").write_text(READ.format(file=name))
        subprocess.run(
            ["liggghts", "-in", "in.s" if name == "in.s" else "in.r", "-log", "none"],
            cwd=tmp_path, check=True, capture_output=True, timeout=60,
        )  # fmt: skip
        if name == "in.s":
            assert written(tmp_path) == set(STEPS)
        else:
            assert (tmp_path / f"{name}.txt").read_text() == f"step {STEPS[name]}\n"
