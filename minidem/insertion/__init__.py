"""Insertion of particles, with the random numbers of LIGGGHTS."""

from typing import Final

__all__ = ["DISTRIBUTION_STYLES", "STYLES"]

STYLES: Final = ("insert/pack", "insert/rate/region", "insert/stream")
"""Insertion styles that are understood."""

DISTRIBUTION_STYLES: Final = (
    "particledistribution/discrete",
    "particledistribution/discrete/massbased",
    "particledistribution/discrete/numberbased",
)
"""The same for distributions."""
