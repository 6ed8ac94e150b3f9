"""The how-to pages, followed to the letter in a copy of the project."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.docs.how_to import ROOT, PageError, changed, copy_of_the_project, follow, steps_of

PAGES = sorted((ROOT / "docs" / "how-to").glob("*.md"))
LONG = ("add-a-contact-law", "draw-a-run", "measure-with-a-camera")
"""A law is in every kernel, which all are compiled anew; the others draw and read many pictures."""
LONG_OR_NOT = [
    pytest.param(page, marks=[pytest.mark.long] if page.stem in LONG else []) for page in PAGES
]


def test_there_is_a_page_for_everything_that_is_made_to_be_added():
    subjects = [
        "a-contact-law",
        "a-fix",
        "a-further-experiment",
        "a-material",
        "an-effect",
        "an-experiment",
    ]
    added = [page.stem for page in PAGES if page.stem.startswith("add-")]
    assert added == [f"add-{subject}" for subject in subjects]


@pytest.mark.slow
@pytest.mark.parametrize("page", LONG_OR_NOT, ids=lambda page: page.stem)
def test_page_is_true_to_the_letter(page: Path, tmp_path: Path):
    if page.stem == "run-on-a-cluster":
        pytest.importorskip("dask_jobqueue")
    follow(page, copy_of_the_project(tmp_path))


@pytest.mark.long
@pytest.mark.slow
def test_laboratory_is_followed_to_liggghts_lines(tmp_path: Path):
    """With the few runs that the page itself offers to those in a hurry, and fewer grains."""
    page = ROOT / "docs" / "tutorial-laboratory.md"
    text = page.read_text(encoding="utf-8")
    assert "With `start = 7` and `runs = 32`" in text
    flanks = "flank_high = 0.8"
    motion = next(line for line in text.splitlines() if line.startswith("+apparatus = { ampl"))[:-2]
    instead = {
        "+start = 12": "+start = 7",
        "+runs = 72": "+runs = 32",
        f"{flanks} }}": f"{flanks}, pour_grains = 300, pour_stages = 2, settle_tau = 8 }}",
        f"{motion} }}": f"{motion}, width_fraction = 0.06 }}",
    }
    home = copy_of_the_project(tmp_path)
    follow(page, home, instead)
    lines = (home / "beads" / "contact.in").read_text(encoding="utf-8")
    assert "coefficientRollingFriction peratomtypepair 2" in lines


def test_a_page_whose_lines_are_gone_fails():
    with pytest.raises(PageError, match="together and once"):
        changed("one\ntwo\n", " one\n+more\n three\n", "file")
    assert changed("one\ntwo\n", " one\n+more\n two\n", "file") == "one\nmore\ntwo\n"


@pytest.mark.parametrize("command", ["$ false", "$ echo no\nyes"])
def test_a_command_that_does_not_do_what_the_page_says_fails(tmp_path: Path, command: str):
    page = tmp_path / "page.md"
    page.write_text(f"Create `a.txt`:\n\n```\na\n```\n\n```console\n{command}\n```\n")
    assert [step.kind for step in steps_of(page.read_text())] == ["create", "run"]
    with pytest.raises(PageError):
        follow(page, tmp_path)
    assert (tmp_path / "a.txt").read_text() == "a\n"
