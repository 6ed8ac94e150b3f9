"""Sentences of a verdict."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from calibrate.causes.judging.levels import Levels
from calibrate.causes.judging.probabilities import Answers
from calibrate.causes.told.words import _uncredited


def _said(doubts: dict[str, float]) -> list[str]:
    found: Any = SimpleNamespace(
        verdict=SimpleNamespace(answers=Answers({}, {}, {}, doubts)), levels=Levels()
    )
    return _uncredited(found)


def test_causes_that_would_fit_only_for_want_of_runs_are_told_with_what_would_decide():
    (said,) = _said({"vague": 0.4, "sure": 0.001})
    assert "vague (0.40)" in said
    assert "--twins N" in said
    assert "sure" not in said
    assert _said({"sure": 0.001}) == []
