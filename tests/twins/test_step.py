"""Whole steps against `step`: order of operations, searches, groups, several runs."""

from __future__ import annotations

from compare import check_scene
from hypothesis import given
from scene import Scene
from strategies import examples, scenes


@examples(40)
@given(scenes(runs=((20,), (1, 19), (7, 13))))
def test_twenty_steps_of_everything(scene: Scene):
    check_scene(scene)
