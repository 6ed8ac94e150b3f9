"""Fixes by class: what is kept between two questions follows every change."""

from __future__ import annotations

from minidem.world.roster import Roster


def test_fixes_of_a_class_follow_the_script():
    fixes = Roster()
    fixes["a"] = 1
    assert fixes.of_kind(int) == [1]
    fixes["b"] = 2
    assert fixes.of_kind(int) == [1, 2]
    fixes["a"] = "other"  # a fix that is given again keeps its place
    assert (fixes.of_kind(int), fixes.of_kind(str)) == ([2], ["other"])
    del fixes["a"]
    assert fixes.of_kind(str) == []
    assert fixes.pop("b") == 2
    assert fixes.of_kind(int) == []
    fixes.update(c=3)
    assert fixes.of_kind(int) == [3]
    fixes.clear()
    assert fixes.of_kind(int) == []


def test_what_is_returned_may_be_changed():
    fixes = Roster()
    fixes["a"] = 1
    fixes.of_kind(int).clear()
    assert fixes.of_kind(int) == [1]
