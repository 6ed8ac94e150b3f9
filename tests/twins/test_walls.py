"""Triangle meshes against `walls`: nearest points, active edges and corners, shared histories.

Covered: flat plates, fans around a corner, facets that count as one plane (``curvature``), single
triangles; at rest, with a surface velocity and in every motion; a mesh's own contact model. Not
covered: meshes at periodic faces (`minidem.world.images`), two motions of one mesh, edges of more
than two triangles.
"""

from __future__ import annotations

import numpy as np
from hypothesis import given

from tests.twins.compare import check_scene
from tests.twins.model_list import FEW
from tests.twins.scene import Mesh, Scene, Sphere
from tests.twins.slow.search import distance_to_triangle
from tests.twins.strategies import examples, materials, scenes


@examples(60)
@given(scenes(walls=("mesh",), ways=("still", "belt"), runs=((1,), (2,))))
def test_meshes_at_rest_follow_the_rules_of_liggghts(scene: Scene):
    check_scene(scene)


@examples(30)
@given(scenes(walls=("mesh",), runs=((1, 2), (3,))))
def test_moving_meshes_take_spheres_along(scene: Scene):
    check_scene(scene)


def test_beside_an_obtuse_corner_the_edge_is_not_prolonged(rng: np.random.Generator):
    """A case from a simulation: LIGGGHTS 3.8.0 finds no contact, 0 N in the first step.

    The last corner is obtuse and nearest to the sphere, which lies beyond the ends of both edges
    there. On the prolongation of an edge its centre would have a nearest point within its radius.
    """
    mm = 1e-3
    corners = ((13.55428, 4.331097, 204.6384), (12.21893, 4.385668, 203.9868),
               (13.23034, 3.810636, 204.6384))  # fmt: skip
    nodes = tuple(tuple(mm * c for c in corner) for corner in corners)
    centre = (10.2806 * mm, 0.804823 * mm, 206.97 * mm)
    sphere = Sphere(centre, (0.0, 0.0, -1.368), (0.0, 0.0, 0.0), 2.5 * mm, 2500.0, 1)
    assert distance_to_triangle(np.array(nodes), np.array(centre)) > sphere.radius
    found = check_scene(
        Scene(
            FEW[0], materials(rng), (sphere,), FEW[0], meshes=(Mesh((nodes,)),),
            size=(0.05, 0.05, 0.3), skin=2.0 * mm,
        )
    )  # fmt: skip
    assert (found.force == 0.0).all()
    assert not found.triangles
