"""Triangle meshes against `walls`: nearest points, active edges and corners, shared histories.

Covered: flat plates, fans around a corner, facets that count as one plane (``curvature``), single
triangles; at rest, with a surface velocity and in every motion; a mesh's own contact model. Not
covered: meshes at periodic faces (`minidem.world.images`), two motions of one mesh, edges of more
than two triangles.
"""

from __future__ import annotations

from compare import check_scene
from hypothesis import given
from scene import Scene
from strategies import examples, scenes


@examples(60)
@given(scenes(walls=("mesh",), ways=("still", "belt"), runs=((1,), (2,))))
def test_meshes_at_rest_follow_the_rules_of_liggghts(scene: Scene):
    check_scene(scene)


@examples(30)
@given(scenes(walls=("mesh",), runs=((1, 2), (3,))))
def test_moving_meshes_take_spheres_along(scene: Scene):
    check_scene(scene)
