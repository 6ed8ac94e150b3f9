"""Neighbour lists against a search over all pairs: periodic images, skin, contact distance."""

from __future__ import annotations

from hypothesis import given

from tests.twins.compare import check_lists
from tests.twins.scene import Scene
from tests.twins.strategies import examples, scenes


@examples(60)
@given(scenes(ways=("still",), runs=((0,), (15,))))
def test_lists_hold_all_that_is_near_and_nothing_else(scene: Scene):
    check_lists(scene)
