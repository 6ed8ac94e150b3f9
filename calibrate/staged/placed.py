"""Tables of runs with the study's own names of material and surface.

A case knows the kind of a surface and the name of its grains only; surfaces of one kind may share
their cases.
"""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd

from calibrate.study.places import Place

__all__ = ["at_place", "placed"]


def placed(runs: pd.DataFrame, places: Sequence[Place]) -> pd.DataFrame:
    """Return runs with the study's names of their places.

    Parameters
    ----------
    runs : DataFrame
        From a campaign.
    places : sequence of Place
        Where each of them belongs, in the same order.
    """
    named = runs.assign(surface=[place.surface for place in places])
    named.insert(1, "material", [place.material for place in places])
    return named


def at_place(runs: pd.DataFrame, place: Place) -> pd.Series[bool]:
    """Return which runs belong to a place."""
    return (
        (runs["material"] == place.material)
        & (runs["surface"] == place.surface)
        & (runs["experiment"] == place.experiment)
    )
