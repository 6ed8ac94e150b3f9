"""Every contact model of the registry against the textbook of `contact`: forces and histories.

Covered here: pairs of spheres of several sizes, densities and types, frozen ones too, through
periodic faces too; normal, tangential, cohesion and rolling models with all settings and
extensions. All combinations run on the loop that serves all, two on loops of their own as well;
`test_interpreted` runs the same tests with kernels in plain Python.
"""

from __future__ import annotations

import pytest
from hypothesis import given

from minidem.kernels.machine.cache import FREE
from tests.minidem.loops import own_loops
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


@pytest.mark.long
@pytest.mark.skipif(not FREE, reason="interpreted kernels are not compiled for a model")
@examples(60)
@given(scenes(runs=((0,), (1,), (2,), (7, 13)), few=True))
def test_loops_of_their_own_follow_the_textbook(scene: Scene):
    with own_loops():
        check_scene(scene)
