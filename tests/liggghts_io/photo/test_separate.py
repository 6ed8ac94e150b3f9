"""Things in a picture are parted where they are apart, however near they lie."""

from __future__ import annotations

import cv2
import numpy as np

from liggghts_io.photo.grains.separate import separated


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
