"""Particles and wall surfaces with published properties.

Sizes and density: Grobbel et al., Powder Technology 2019, table B.1 and section 2.1; elastic
constants: table B.2 (softened on purpose, section 3.1.4 there).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from difflib import get_close_matches
from typing import Final

from liggghts_io.errors import CaseError

GLUED: Final = "glued"
"""A wall laminated with particles."""

GLUED_FRICTION: Final = 1000.0
"""Its sliding and rolling friction."""

SURFACES: Final = ("steel", "alumina", GLUED)
CONTACT_PARAMETERS: Final = ("mu_pp", "mu_roll_pp", "mu_pw", "mu_roll_pw", "e_pp", "e_pw")
GLUED_PARAMETERS: Final = ("mu_pp", "mu_roll_pp", "e_pp")
"""What a case on a glued surface depends on; the wall takes the restitution of the particles."""


@dataclass(frozen=True)
class Particle:
    """A bulk solid made of nearly round grains.

    Attributes
    ----------
    name : str
    d32_m, d10_m, d50_m, d90_m : float
        Sauter diameter and number quantiles of the diameter [m].
    density : float
        [kg/m3]
    youngs_modulus : float
        [Pa]
    poisson_ratio : float
        [-]
    flow_flat_kg_s, flow_glued_kg_s : float
        Mass flow of the funnel used with the flat and with the glued plate [kg/s] (table B.9; which
        column belongs to which plate is not certain in the source).
    impact_mass_kg : float
        Mass poured in the plate impact experiment [kg] (table B.6).
    """

    name: str
    d32_m: float
    d10_m: float
    d50_m: float
    d90_m: float
    flow_flat_kg_s: float
    flow_glued_kg_s: float
    impact_mass_kg: float
    density: float = 3560.0
    youngs_modulus: float = 5e6
    poisson_ratio: float = 0.3

    @property
    def mass_kg(self) -> float:
        """Mass of one grain of Sauter diameter [kg]."""
        return self.density * math.pi / 6.0 * self.d32_m**3


_TABLE: Final = (
    ("Carbo HSP13", 1595, 1344, 1547, 1774, 24.16, 18.97, 68.73),
    ("SG10H", 1201, 1019, 1176, 1322, 23.78, 20.15, 33.79),
    ("Carbo HSP16/30", 1101, 917, 1052, 1247, 23.89, 21.27, 34.83),
    ("Carbo HSP20/40", 826, 703, 800, 919, 25.83, 22.99, 30.87),
    ("Carbo HSP30/60", 603, 496, 578, 677, 29.00, 26.12, 17.64),
)
PARTICLES: Final = {
    row[0]: Particle(
        row[0],
        *(micrometre * 1e-6 for micrometre in row[1:5]),
        *(gram * 1e-3 for gram in row[5:8]),
    )
    for row in _TABLE
}


def nearest(word: str, known: tuple[str, ...] | list[str]) -> str:
    """Return the hint that ends an error message about an unknown word."""
    close = get_close_matches(word, known, n=1, cutoff=0.4)
    hint = f"; did you mean {close[0]!r}?" if close else ""
    return f"{hint} (known: {', '.join(known)})"


def particle_named(name: str) -> Particle:
    """Return the particle of that name.

    Raises
    ------
    CaseError
        For an unknown name, with the nearest known one.
    """
    try:
        return PARTICLES[name]
    except KeyError:
        msg = f"unknown particle {name!r}{nearest(name, list(PARTICLES))}"
        raise CaseError(msg) from None
