"""Things in a picture are parted where they are apart, however near they lie."""

from __future__ import annotations

import cv2
import numpy as np

from liggghts_io.photo.grains.oblong import oblong, rejoined
from liggghts_io.photo.grains.separate import Blobs, separated


def test_nothing_climbs_over_the_ground():
    """A thin thing near a thick one: over the gap the blurred distance rises to the thick one.

    Who climbed there came to the first thing of the picture, wherever that is.
    """
    image = np.zeros((60, 90), dtype=np.float32)
    image[3:13, 3:13] = 1.0
    image[20:50, 10:45] = 1.0
    image[20:50, 46:49] = 1.0
    blobs = separated(image, 60.0)
    _, apart = cv2.connectedComponents((image > 0.5).astype(np.uint8), connectivity=8)
    assert blobs.count == 3
    pairs = {(int(a), int(b)) for a, b in zip(apart.ravel(), blobs.labels.ravel(), strict=True)}
    assert len(pairs) == 4  # the ground and three things, none of them in parts


def test_pieces_are_one_where_they_fill_an_ellipse():
    """Two discs that touch stay two, and so do two long grains side by side."""
    labels = np.zeros((200, 200), dtype=np.int32)
    for number, middle, axes in (
        (1, (40, 40), (30, 10)), (3, (40, 100), (15, 15)), (4, (70, 100), (15, 15)),
        (5, (140, 40), (30, 10)), (6, (140, 60), (30, 10)),
    ):  # fmt: skip
        drawn = cv2.ellipse(np.zeros(labels.shape, np.uint8), middle, axes, 0, 0, 360, 1, -1)
        labels[(drawn > 0) & (labels == 0)] = number
    labels[:, 45:][labels[:, 45:] == 1] = 2  # a long grain in two parts
    areas = np.bincount(labels.ravel())[1:].astype(np.float64)
    blobs = rejoined(Blobs(labels, 6, areas, np.sqrt(areas / np.pi)))
    assert blobs.count == 5
    assert len(np.unique(blobs.labels[30:50, 10:70])) == 2  # the ground, and one grain
    assert oblong(blobs).all()
