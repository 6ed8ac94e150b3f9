"""What stands out in a photograph, and is no heap: too steep, crooked, or of another shape."""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from liggghts_io.errors import CaseError
from liggghts_io.measure.flanks import FloatArray, Repose, angle_error, fit_line, residuals
from liggghts_io.photo.light import Mask

_ANGLES: Final = (4.0, 65.0)  # deg, of a flank
_UNEQUAL: Final = 25.0  # deg, between both flanks
_ROUGH: Final = 0.05  # of the height: scatter of the outline about its flanks, 13 grains high
_ROUGH_ALONE: Final = 0.02  # the same where there is one flank only
_CUT: Final = 0.5  # of the height: a heap that the picture cuts, where one flank is all there is
_LAST: Final = 0.01  # of the width
_AREA: Final = (0.55, 1.4)  # outline's area over that of the triangle between its feet and top
_FOOT: Final = 0.06  # of the height: below it a heap's foot and the plate look alike
_SOLID: Final = 0.8  # of what is below the outline, down to the plate
_BENT: Final = 9.0  # deg between the halves of a flank
_HALF: Final = 127.5  # grey level of an edge in a silhouette
_PEAK: Final = (0.8, 1.45)  # height where the flanks meet, over that of the heap


def check_heap(repose: Repose, mask: Mask, image: npt.NDArray[np.uint8]) -> None:
    """Refuse what is no heap.

    Parameters
    ----------
    repose : Repose
        As it was measured.
    mask : (rows, columns) bool
        What stands out in the photograph.
    image : (rows, columns) uint8
        Its silhouette, black on white, the plate as lower border.

    Raises
    ------
    CaseError
        Saying what it is instead.
    """
    _check_flanks(repose)
    _check_cut(repose, mask)
    _check_whole(image)


def _check_flanks(repose: Repose) -> None:
    """Refuse what is no heap: too steep, too flat, crooked, lopsided, or of another shape."""
    angles = np.array([repose.left_deg, repose.right_deg])
    angles = angles[np.isfinite(angles)]
    if angles.min() < _ANGLES[0] or angles.max() > _ANGLES[1]:
        msg = f"what stands out has sides of {' and '.join(f'{one:.0f}' for one in angles)} deg"
        raise CaseError(msg)
    if np.ptp(angles) > _UNEQUAL:
        msg = f"what stands out has sides as unequal as {angles[0]:.0f} and {angles[1]:.0f} deg"
        raise CaseError(msg)
    x, z = repose.outline.T
    rough = _ROUGH if len(repose.lines) == 2 else _ROUGH_ALONE
    bent, errors, crooked = [], [], False
    for line in repose.lines:
        low, high = np.sort(line[:, 0])
        flank = repose.outline[(x >= low) & (x <= high)]
        _, rest = residuals(flank, line)
        crooked |= bool(np.sqrt(np.mean(rest**2)) > rough * repose.height_m)
        (upper, upper_line), (lower, lower_line) = (
            (half, fit_line(half)) for half in np.array_split(flank, 2)
        )
        bent.append(abs(lower_line[1] - upper_line[1]))
        errors.append(
            np.hypot(angle_error(upper, upper_line[0]), angle_error(lower, lower_line[0]))
        )
    # Few grains lie as they fell: two errors of such a bend are allowed.
    if crooked or np.mean(bent) > _BENT + 2.0 * np.mean(errors):
        msg = "what stands out has no straight flanks"
        raise CaseError(msg)
    if len(repose.lines) == 2:
        _check_shape(repose, x, z)


def _check_cut(repose: Repose, mask: Mask) -> None:
    """Refuse what lacks a flank although there is room for it in the picture.

    A plate reaches the border, too: a heap that is cut there is still high.
    """
    z = repose.outline[:, 1]
    last = max(3, round(_LAST * len(z)))  # the very last columns of a drawing fade
    edges = (
        ("left", repose.left_deg, mask[:, 0], z[:last].max()),
        ("right", repose.right_deg, mask[:, -1], z[-last:].max()),
    )
    for name, angle, edge, high in edges:
        cut = edge.any() and high > _CUT * repose.height_m
        if not np.isfinite(angle) and not cut:
            msg = f"what stands out has no straight flank on the {name}"
            raise CaseError(msg)


def _check_whole(image: npt.NDArray[np.uint8]) -> None:
    """Refuse what does not stand on the plate, such as a stripe or an arch."""
    black = image < _HALF
    under = np.logical_or.accumulate(black, axis=0)
    if black.sum() < _SOLID * under.sum():
        msg = "what stands out does not reach down to the plate"
        raise CaseError(msg)


def _check_shape(repose: Repose, x: FloatArray, z: FloatArray) -> None:
    """Refuse what has two flanks, but not the shape of a heap."""
    (lx, lz), (rx, rz) = repose.lines.mean(axis=1)
    rise, fall = np.tan(np.radians([repose.left_deg, repose.right_deg]))
    meet = (rz - lz + rise * lx + fall * rx) / (rise + fall)
    peak = (lz + rise * (meet - lx)) / repose.height_m
    if not _PEAK[0] < peak < _PEAK[1]:
        msg = "what stands out has flanks that meet far from its top"
        raise CaseError(msg)
    tall = z > _FOOT * repose.height_m
    base = float(np.ptp(x[tall]))
    if tall[0] or tall[-1]:  # cut by the picture's edge
        return
    area = float(np.sum(z[tall]) * np.median(np.diff(x))) / (0.5 * repose.height_m * base)
    if not _AREA[0] < area < _AREA[1]:
        msg = f"what stands out fills {area:.1f} times the triangle of a heap"
        raise CaseError(msg)
