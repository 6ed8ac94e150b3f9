"""Things in a picture are parted where they are apart, however near they lie."""

from __future__ import annotations

import cv2
import numpy as np

from liggghts_io.photo.grains.separate import separated


def test_nothing_climbs_over_the_ground():
    """A thin thing near a thick one: over the gap the blurred distance rises to the thick one."""
    image = np.zeros((40, 80), dtype=np.float32)
    image[5:35, 5:40] = 1.0
    image[5:35, 41:44] = 1.0
    blobs = separated(image, 30.0)
    _, apart = cv2.connectedComponents((image > 0.5).astype(np.uint8), connectivity=8)
    assert blobs.count == 2
    pairs = {(int(a), int(b)) for a, b in zip(apart.ravel(), blobs.labels.ravel(), strict=True)}
    assert len(pairs) == 3  # the ground and two things, none of them in parts
