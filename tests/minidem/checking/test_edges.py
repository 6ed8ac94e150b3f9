"""Which nodes and edges triangles have in common."""

from __future__ import annotations

import numpy as np
import pytest

from minidem.world.mesh.edges import edges_of, node_numbers

SIDES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
"""Corners of the faces of a tetrahedron."""


def test_a_closed_surface_has_every_edge_twice():
    corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    number = node_numbers(corners[SIDES])
    assert len(np.unique(number)) == 4
    shared = edges_of(number)
    assert len(shared) == 6
    for i, edge_i, j, edge_j in shared:
        ends = {number[i, edge_i], number[i, (edge_i + 1) % 3]}
        assert ends == {number[j, edge_j], number[j, (edge_j + 1) % 3]}


@pytest.mark.parametrize("seed", range(4))
def test_equal_nodes_have_one_number_in_ascending_order(seed):
    rng = np.random.default_rng(seed)
    nodes = rng.integers(-1, 2, (12, 3, 3)).astype(float)
    nodes[rng.random(nodes.shape) < 0.1] = -0.0  # equal to zero
    wanted = np.unique(nodes.reshape(-1, 3), axis=0, return_inverse=True)[1]
    assert node_numbers(nodes).ravel().tolist() == wanted.ravel().tolist()


def test_nodes_nearer_than_asked_are_one():
    nodes = np.array([[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]] * 2)
    nodes[1] += 0.4e-3
    assert np.array_equal(*node_numbers(nodes, 1e-3))
    assert len(np.unique(node_numbers(nodes, 1e-5))) == 6


def test_no_triangle_has_no_node():
    assert node_numbers(np.zeros((0, 3, 3))).shape == (0, 3)
