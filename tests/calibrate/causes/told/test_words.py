"""Sentences of a verdict."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from calibrate.causes.judging.instead import Instead
from calibrate.causes.judging.levels import Levels
from calibrate.causes.judging.probabilities import Answers
from calibrate.causes.judging.visibility import Visible
from calibrate.causes.told.words import LISTED, _limits, _uncredited


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


def _visible(name: str, detectable: float, achieved: float, instead: Instead | None) -> Visible:
    return Visible(name, 0.1, detectable, achieved, 1.0, 0.5, {}, (), instead)


def _limits_of(*candidates: Visible) -> list[str]:
    found: Any = SimpleNamespace(
        visibility=SimpleNamespace(candidates=candidates), log_ratio=lambda _name: 0.0
    )
    return _limits(found)


def test_what_other_parameters_do_the_same_is_told_apart_from_what_cannot_be_seen():
    never = float("inf")
    smaller = Instead("e_pp", 0.746, 0.343)
    said = _limits_of(
        _visible("slope", 0.2, never, smaller),
        _visible("blind", 3.0, never, None),
        _visible("never_seen", never, never, None),
        _visible("blind_and_like_another", 3.0, never, smaller),
        _visible("told_when_strong", 0.2, 0.8, smaller),
        _visible("told", 0.2, 0.4, None),
    )
    assert said == [
        "These data cannot show, at any plausible strength: blind (needs 3), "
        "never_seen, blind_and_like_another (needs 3).",
        "Other parameters do the same, however strong they are: "
        "slope (e_pp 0.343 in place of 0.746).",
    ]
    (many,) = _limits_of(*[_visible(f"c{k}", 0.2, never, smaller) for k in range(LISTED + 2)])
    assert many.endswith("and 2 more, see the table.")
    assert many.count("e_pp") == LISTED
