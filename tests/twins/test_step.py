"""Whole steps against `step`: order of operations, searches, groups, several runs."""

from __future__ import annotations

from hypothesis import given

from tests.twins.compare import check_scene
from tests.twins.scene import Scene
from tests.twins.strategies import examples, scenes


@examples(40)
@given(scenes(runs=((20,), (1, 19), (7, 13))))
def test_twenty_steps_of_everything(scene: Scene):
    check_scene(scene)
