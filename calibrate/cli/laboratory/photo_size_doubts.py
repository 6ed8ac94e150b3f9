"""What about photos of grains makes the sizes doubtful, in sentences."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from liggghts_io.photo.grains.result import GrainSizes
from liggghts_io.photo.grains.shapes import CLUMP, DUST, OTHER

__all__ = ["size_doubts"]

_FEW: Final = 50
_COARSE_PX: Final = 8.0
_CLUMPED: Final = 0.1
_OTHERS: Final = 0.1
_FEW_OTHERS: Final = 5  # tracers


def size_doubts(
    each: Sequence[GrainSizes], total: GrainSizes, left: Mapping[str, int]
) -> list[str]:
    """Return what a person should know before the sizes are used.

    Parameters
    ----------
    each : sequence of GrainSizes
        Of every photo.
    total : GrainSizes
        Of all photos together.
    left : mapping of str to int
        Things that do not count, by the reason; 0 for a reason that is not in it.
    """
    said = []
    across = min(one.pixels_across for one in each)
    if across < _COARSE_PX:
        said.append(
            f"grains are {across:.1f} px across; from {_COARSE_PX:.0f} on sizes are sure where "
            "grains stand out and lie apart"
        )
    if total.count < _FEW:
        said.append(f"{total.count} grains tell little of d10 and d90; photograph more")
    if any(one.shadows for one in each):
        said.append(
            "grains throw shadows to one side, which were left out: their outline there is that "
            "of an ellipse, and circularity says nothing; light from two sides tells more"
        )
    growth = max(one.growth() for one in each)
    if growth:
        said.append(
            f"grains look {100.0 * growth:.0f} % larger on one side of the photo than opposite: "
            "the camera looked at them obliquely, or they are sorted; hold it square above them"
        )
    clumps = left.get(CLUMP, 0)
    if clumps > _CLUMPED * total.count:
        said.append(f"{clumps} clumps were not separated; spread the grains farther apart")
    others = left.get(OTHER, 0)
    if others > max(_OTHERS * total.count, _FEW_OTHERS):
        said.append(
            f"{others} grains are of other brightness or colour than the {total.count} that count; "
            "photograph them on a ground that differs from both, or each kind with --grains"
        )
    dust = left.get(DUST, 0)
    if dust > _CLUMPED * total.count:
        said.append(
            f"{dust} things are so small that they were taken for dust; if they are grains, d10 "
            "and d50 are too large: go nearer with the camera"
        )
    if not np.isfinite(total.d32_se_m):
        said.append("one grain tells nothing of others")
    return said
