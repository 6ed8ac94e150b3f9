"""How far liquid bridges reach, and how far neighbours are looked for because of them."""

from __future__ import annotations

from collections.abc import Sequence
from math import pi

import numpy as np

from minidem.errors import InputError
from minidem.fixes.templates import TemplateFix
from minidem.kernels.columns import COHESION, LIMITS_LIQUID, RADIUS, SETS_BRIDGES
from minidem.kernels.models import EASO, LARGEST_GAP
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["set_reach"]

_NEIGHBOURS = 1.1  # of the largest separation, as in LIGGGHTS
_USUAL_SHARE = 0.05
_TWO_SPHERES = 2666.666666 * pi  # litres of two spheres of radius 1 m, as LIGGGHTS writes it
_LITRE_EDGE = 0.1  # m


def set_reach(world: World, used: Sequence[Sequence[int]], coefficients: Floats) -> None:
    """Set the largest gap of bridges, and widen ``contact_distance_factor`` for good.

    Parameters
    ----------
    world : World
        Its particles and templates tell the radii.
    used : sequence of switches
        The models in use.
    coefficients : ndarray
        See `minidem.contact.coefficients.coefficient_table`; receives the gap.

    Raises
    ------
    InputError
        If the separation is too small, or models disagree about it.
    """
    wet = [switches for switches in used if switches[COHESION] >= EASO]
    if not wet:
        return
    given = float(world.materials.values["maxSeparationDistanceRatio"].ravel()[0])
    if given < 1.0 and any(switches[COHESION] == EASO for switches in wet):
        msg = (
            f"maxSeparationDistanceRatio is {given:g}; cohesion model easo/capillary/viscous "
            "requires maxSeparationDistanceRatio >= 1.0. Please increase this value"
        )
        raise InputError(msg)
    ratios = {_limited(world, one) if one[LIMITS_LIQUID] else given for one in wet}
    if len(ratios) > 1:
        msg = (
            "'limitLiquidContent on' sets how far bridges reach, so that the pair style and all "
            "walls with liquid bridges must have it, with the same 'modifyLbVolume', or none"
        )
        raise InputError(msg)
    ratio = ratios.pop()
    coefficients[:, LARGEST_GAP] = ratio - 1.0
    world.neighbor.reach = max(world.neighbor.reach, _NEIGHBOURS * ratio)
    if ratio != given:
        world.warn(
            "maxLiquidContent was specified, resulting in maxSeparationDistanceRatio being "
            f"overwritten by {ratio:e} (was {given:e})"
        )


def _limited(world: World, switches: Sequence[int]) -> float:
    """Return the separation ratio of the largest bridge that limited contents allow."""
    radii = [fix.template.radius for fix in world.of_kind(TemplateFix)]
    radii += world.state.row[: world.state.n, RADIUS].tolist()
    largest, smallest = max(radii, default=0.0), min(radii, default=1.0)
    share = _USUAL_SHARE
    if switches[SETS_BRIDGES]:
        share = float(world.materials.values["lbVolumeFraction"].ravel()[0])
    content = world.materials.values["maxLiquidContent"].ravel()
    angle = np.radians(world.materials.values["contactAngle"].ravel())
    volume = _TWO_SPHERES * largest * largest * largest * content * share
    gaps = (1.0 + 0.25 * angle * angle) * np.cbrt(volume) * _LITRE_EDGE
    return float(1.0 + max(0.5 * gaps.max(initial=0.0) / smallest, 0.0))
