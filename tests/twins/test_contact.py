"""Every contact model of the registry against the textbook of `contact`: forces and histories.

Covered here: pairs of spheres of several sizes, densities and types, frozen ones too, through
periodic faces too; normal, tangential, cohesion and rolling models with all settings and
extensions. Compiled: a few base models and every combination that has an extension (they share one
loop); `test_interpreted` runs the same tests for all combinations.
"""

from __future__ import annotations

from hypothesis import given

from tests.twins.compare import check_scene
from tests.twins.scene import Scene
from tests.twins.strategies import examples, scenes


@examples(60)
@given(scenes(walls=(), runs=((0,), (1,), (2,))))
def test_pairs_follow_the_textbook(scene: Scene):
    check_scene(scene)


@examples(60)
@given(scenes(walls=("plane", "cylinder"), runs=((0,), (1,), (2,))))
def test_walls_follow_the_textbook(scene: Scene):
    check_scene(scene)
