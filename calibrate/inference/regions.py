"""Separate regions of a posterior, found by whether a likely path joins two draws.

Two neighbouring draws belong together if nowhere between them the posterior falls a valley's depth
below the lower of the two. So a bent ridge hangs together, and two humps do not.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

from calibrate.arrays import Array
from calibrate.inference.posterior import Region
from calibrate.inference.sampler.target import Target
from calibrate.inference.space import Space

__all__ = ["find_regions"]

_DRAWS: Final = 400  # that stand for all
_NEIGHBOURS: Final = 10
_BETWEEN: Final = (0.25, 0.5, 0.75)
_VALLEY: Final = 1.0  # nats
_LEAST: Final = 0.01  # share of the probability below which a region is noise of the draws


def find_regions(target: Target, z: Array) -> Array:
    """Return the region of every draw, (n,) int, the most probable being 0.

    Parameters
    ----------
    target : Target
    z : (n, K) float64
        Draws of equal weight, in the target's coordinates.
    """
    some = z[np.linspace(0, len(z) - 1, min(_DRAWS, len(z))).astype(int)]
    scale = z.std(axis=0) + np.finfo(float).eps
    log_p = target.log_posterior(some)
    count = min(_NEIGHBOURS + 1, len(some))
    near = KDTree(some / scale).query(some / scale, k=count)[1].reshape(len(some), count)
    i = np.repeat(np.arange(len(some)), count - 1)
    j = near[:, 1:].ravel()
    lower = np.minimum(log_p[i], log_p[j])
    joined = np.ones(len(i), dtype=bool)
    for share in _BETWEEN:
        joined &= target.log_posterior((1.0 - share) * some[i] + share * some[j]) > lower - _VALLEY
    edges = (np.ones(int(joined.sum())), (i[joined], j[joined]))
    graph = coo_matrix(edges, shape=(len(some), len(some)))
    _, label = connected_components(graph, directed=False)
    sizes = np.bincount(label)
    large = np.flatnonzero(sizes >= max(_LEAST * len(some), 2))
    if not len(large):
        return np.zeros(len(z), dtype=int)
    order = large[np.argsort(-sizes[large])]
    kept = np.isin(label, order)
    rank = np.array([int(np.flatnonzero(order == one)[0]) for one in label[kept]])
    nearest = KDTree(some[kept] / scale).query(z / scale)[1]
    return np.asarray(rank[nearest])


def describe(space: Space, samples: Array, label: Array) -> tuple[Region, ...]:
    """Return the regions of labelled samples, (n, K), the most probable first."""
    found = []
    for number in np.unique(label):
        own = samples[label == number]
        low, high = np.percentile(own, [5.0, 95.0], axis=0)
        mean = space.values_of(space.units(own).mean(axis=0)[None])[0]
        found.append(Region(len(own) / len(samples), low, high, mean))
    return tuple(sorted(found, key=lambda one: -one.weight))
