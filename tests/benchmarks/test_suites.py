"""The page of the blind suites shows what their stored scores say."""

from __future__ import annotations

import math

import pytest

from benchmarks import limit
from benchmarks.suites import PAGE, SUITES, figures, filled, missed, shown


def test_the_page_shows_what_the_command_makes():
    text = PAGE.read_text(encoding="utf-8")
    assert filled(text) == text
    assert "<!-- suite_1 -->" in text


def test_every_suite_that_is_kept_is_on_the_page():
    text = PAGE.read_text(encoding="utf-8")
    for seals in SUITES.glob("*/sealed.json"):
        assert f"<!-- {seals.parent.name} -->" in text
        assert "studies, drawn from commit" in shown(seals.parent.name)[0]


@pytest.mark.parametrize(
    ("required", "ours", "known", "where"),
    [
        ("<= 0.03", 0.0176, 0.5, ""),
        ("<= 0.03", 0.036, 0.0, "ours"),
        (">= 0.70 (known)", 0.1, 0.8, ""),
        (">= 0.70 (known)", 0.9, 0.6, "known"),
        ("0.80 to 0.97", 0.98, 0.9, "ours"),
        ("0.80 to 0.97", 0.80, 0.0, ""),
        (">= 0.70", math.nan, 0.0, ""),
        ("", 0.0, 0.0, ""),
    ],
)
def test_a_figure_that_misses_what_is_required_is_bold(required, ours, known, where):
    row = {"figure": "f", "required": required, "studies": 7, "ours": ours, "known": known}
    assert missed(row) == where
    line = figures([row])[-1]
    assert line.count("**") == (2 if where else 0)
    assert f"| f | {required.replace('<=', 'at most').replace('>=', 'at least')} | 7 |" in line


def test_the_page_says_what_could_be_told_at_most(capsys):
    """Of the kept forecasts; the numbers in the text are those that the command prints."""
    limit.main()
    most, told = capsys.readouterr().out.splitlines()
    assert most.startswith("limit: at 5.6 26 of 45 right, 40 in the set, probability 0.62")
    assert most.endswith("pairs at 11 whole 3 of 6, one of both 23 of 30")
    assert told.startswith("ours: at 5.6 24 of 45 right")
    text = PAGE.read_text(encoding="utf-8")
    assert "the diagnosis tells 26 of the 45" in text
    assert "three of the six whole, and one of both in 23 of 30 pairs where 22 are told" in text
