"""Where a region meets the box: what is kept holds for the same box only."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from minidem.errors import DemError
from minidem.insertion.room import Room
from minidem.insertion.settings import Domain
from minidem.kernels.columns import DOMAIN, DRAWN

EXTENT = np.array([[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]])
BOX = np.array([[-2.0, -2.0, -2.0], [2.0, 2.0, 2.0]])


def room() -> Room:
    settings = SimpleNamespace(all_in=True, distribution=SimpleNamespace(max_radius=0.1))
    return Room("ins", EXTENT, settings)  # type: ignore[arg-type]


def test_corners_follow_the_box():
    place = room()
    assert np.array_equal(place.within(BOX, 0.1, 1)[0][DRAWN], EXTENT)
    box = BOX.copy()
    box[1, 2] = 0.75
    assert place.within(box, 0.1, 1)[0][DRAWN, 1].tolist() == [1.0, 1.0, 0.75]
    box[1, 2] = 0.5  # the same array with other numbers is another box
    corners, _ = place.within(box, 0.1, 1)
    assert corners[DRAWN, 1].tolist() == [1.0, 1.0, 0.5]
    assert np.array_equal(corners[DOMAIN], box)


def test_a_larger_sphere_is_looked_at_again():
    place = room()
    place.within(BOX, 0.1, 1)
    with pytest.raises(DemError, match=r"too small for spheres of diameter 1\.2 m"):
        place.within(BOX, 0.6, 1)


def test_memory_is_kept_while_it_suffices():
    place = room()
    _, grid = place.within(BOX, 0.1, 8)
    assert place.within(BOX.copy(), 0.1, 12)[1] is grid  # half as many again may come
    assert len(grid.head) == 5**3  # cells as wide as a sphere
    more = place.within(BOX, 0.1, 13)[1]
    assert len(more.sphere) == len(more.following) == 19
    assert len(place.within(BOX, 0.05, 13)[1].head) == 10**3  # smaller cells for smaller spheres


def test_a_face_that_is_fixed_later_is_looked_at_again():
    place = room()
    box = BOX.copy()
    box[1, 0] = 0.5
    place.check(Domain(box, ("mm", "mm", "mm")))
    with pytest.raises(DemError, match="extends outside the simulation box"):
        place.check(Domain(box, ("ff", "mm", "mm")))


def test_a_box_that_shrinks_is_looked_at_again():
    place, box = room(), BOX.copy()
    place.check(Domain(box, ("ff", "ff", "ff")))
    box[1, 0] = 0.5
    with pytest.raises(DemError, match="extends outside the simulation box"):
        place.check(Domain(box, ("ff", "ff", "ff")))
