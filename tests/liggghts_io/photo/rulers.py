"""Photographs of grains with a ruler as shops sell them below: ticks of three lengths, numbers."""

from __future__ import annotations

import cv2
import numpy as np

FINER = 3
GROUND = (205, 203, 198)
GRAINS = 36
RADIUS = 12.0  # px
TOP, BOTTOM = 430, 490  # px, of the ruler in a picture of 700 x 500
LEFT = 30


def close_up(
    tick: float, face: tuple[int, int, int], *, wide: float = 1.5, length: float = 560.0
) -> np.ndarray:
    """Return a picture three times too fine: grains in disorder, and a ruler below them."""
    light = np.full((500 * FINER, 700 * FINER, 3), GROUND, np.uint8)
    rng = np.random.default_rng(1)
    for k in range(GRAINS):
        at = np.array([60 + 72 * (k % 9), 60 + 95 * (k // 9)]) + rng.uniform(-20, 20, 2)
        middle = np.round(at * FINER).astype(int).tolist()
        cv2.circle(light, middle, round(RADIUS * FINER), (70, 65, 60), -1)
    count = int(length / tick)
    light[TOP * FINER : BOTTOM * FINER, (LEFT - 6) * FINER : round(LEFT + length + 20) * FINER] = (
        face
    )
    for k in range(count + 1):
        deep = 36 if k % 10 == 0 else 27 if k % 5 == 0 else 18
        x = LEFT + k * tick
        light[
            TOP * FINER : (TOP + deep) * FINER,
            round((x - wide / 2) * FINER) : round((x + wide / 2) * FINER),
        ] = 20
        if k % 10 == 0:
            where = (round((x + 3) * FINER), (BOTTOM - 6) * FINER)
            cv2.putText(light, str(k // 10), where, 0, 1.4, (20, 20, 20), 3)
    return light


def photograph(light: np.ndarray, shrink: float = 1.0, noise: float = 2.0) -> np.ndarray:
    """Return what a camera makes of it, of 700 x 500 px where it does not shrink."""
    size = (round(700 / shrink), round(500 / shrink))
    small = cv2.GaussianBlur(cv2.resize(light, size, interpolation=cv2.INTER_AREA), (0, 0), 0.7)
    grain = np.random.default_rng(2).normal(0, noise, small.shape)
    return np.clip(np.round(small + grain), 0, 255).astype(np.uint8)
