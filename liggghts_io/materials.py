"""What a case is made of: the record of a bulk solid, wall surfaces, contact parameters."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Final, TypeAlias

from liggghts_io.errors import CaseError, nearest

FLAT: Final = "flat"
"""A bare wall, whatever it is made of: its contact parameters say that."""

GLUED: Final = "glued"
"""A wall laminated with particles."""

GLUED_FRICTION: Final = 1000.0
"""Its sliding and rolling friction."""

KINDS: Final = (FLAT, GLUED)
"""Kinds of a wall under test; a run depends on the kind, never on the name of the material."""

_KIND_OF: Final = {FLAT: FLAT, "steel": FLAT, "alumina": FLAT, GLUED: GLUED}
SURFACES: Final = tuple(_KIND_OF)
CONTACT_PARAMETERS: Final = ("mu_pp", "mu_roll_pp", "mu_pw", "mu_roll_pw", "e_pp", "e_pw")
GLUED_PARAMETERS: Final = ("mu_pp", "mu_roll_pp", "e_pp")
"""What a case on a glued surface depends on; the wall takes the restitution of the particles."""

_FRICTION: Final = (0.0, 1000.0)
_RESTITUTION: Final = (0.05, 1.0)
"""What LIGGGHTS takes; restitution has to be above its lower limit."""

YOUNGS_MODULUS: Final = 5e6
POISSON_RATIO: Final = 0.3
"""Elastic constants [Pa], [-] where a material names none: table B.2 of Grobbel et al., Powder
Technology 2019, softened on purpose (section 3.1.4 there) to allow longer time steps."""

ONE: Final = "one"
MEASURED: Final = "measured"
SIZES: Final = (ONE, MEASURED)
"""Sizes of the simulated grains: all of Sauter diameter, or as they were measured."""

SizeClasses: TypeAlias = tuple[tuple[float, float], ...]
"""Pairs of diameter [m] and share of the number of grains, from small to large."""

# What is missing, as a person would write it in a table or a study.
_MISSING: Final = {
    "size_classes": "size distribution (d10_um, d50_um and d90_um, or sieve)",
    "flow_flat_kg_s": "flow_flat_g_s (mass flow of the funnel used with flat plates)",
    "flow_glued_kg_s": "flow_glued_g_s (mass flow of the funnel used with glued plates)",
    "impact_mass_kg": "impact_mass_g (mass poured in the plate impact)",
}


def kind_of(surface: str) -> str:
    """Return the kind of a surface, "flat" or "glued".

    Raises
    ------
    CaseError
        For an unknown name, with the nearest known one.

    Examples
    --------
    >>> kind_of("alumina")
    'flat'
    """
    try:
        return _KIND_OF[surface]
    except KeyError:
        msg = f"unknown surface {surface!r}{nearest(surface, SURFACES)}"
        raise CaseError(msg) from None


def check_contact(name: str, value: float) -> None:
    """Refuse a contact parameter that the engines would not take.

    Raises
    ------
    CaseError
        With name, value and limits.
    """
    restitution = name.startswith("e_")
    low, high = _RESTITUTION if restitution else _FRICTION
    if not low <= value <= high or (restitution and value == low):
        msg = f"{name} = {value:g} outside {low:g} to {high:g}"
        raise CaseError(msg)


@dataclass(frozen=True)
class Particle:
    """A bulk solid made of nearly round grains.

    Attributes
    ----------
    name : str
    d32_m : float
        Sauter diameter [m].
    density : float
        Of a grain, without the space between grains [kg/m3].
    youngs_modulus : float
        [Pa]
    poisson_ratio : float
        [-]
    size_classes : tuple of (float, float)
        Diameter [m] and number share of each class; empty where the spread is not known.
    flow_flat_kg_s, flow_glued_kg_s : float or None
        Mass flow of the funnel used with the flat and with the glued plate [kg/s].
    impact_mass_kg : float or None
        Mass poured in the plate impact experiment [kg].
    sizes : str
        Of the simulated grains: "one" for all of Sauter diameter, "measured" for `size_classes`.
        Without it as measured where they were, since one diameter is knowingly wrong; but one in a
        script that has grains of its own, or with an effect that spreads them.
    coarse_graining : float
        Diameter of the simulated over that of the real grains; masses and flows stay.
    """

    name: str
    d32_m: float
    density: float
    youngs_modulus: float = YOUNGS_MODULUS
    poisson_ratio: float = POISSON_RATIO
    size_classes: SizeClasses = ()
    flow_flat_kg_s: float | None = None
    flow_glued_kg_s: float | None = None
    impact_mass_kg: float | None = None
    sizes: str = ""
    coarse_graining: float = 1.0

    @property
    def base_sizes(self) -> str:
        """What of the sizes is simulated where nothing in the case is against it."""
        return self.sizes or (MEASURED if self.size_classes else ONE)

    @property
    def mass_kg(self) -> float:
        """Mass of one real grain of Sauter diameter [kg]."""
        return self.density * math.pi / 6.0 * self.d32_m**3

    def amount(self, field: str) -> float:
        """Return one of the optional numbers.

        Raises
        ------
        CaseError
            If it was not given.
        """
        self.need([field], "the experiment")
        return float(getattr(self, field))

    def has(self, fields: Sequence[str]) -> bool:
        """Whether all of these optional fields were given."""
        return all(getattr(self, name) not in (None, ()) for name in fields)

    def need(self, fields: Sequence[str], what: str) -> None:
        """Refuse a particle without these optional fields.

        Parameters
        ----------
        fields : sequence of str
            Optional fields of this record.
        what : str
            What needs them, for the message.

        Raises
        ------
        CaseError
        """
        for name in fields:
            if not self.has([name]):
                msg = (
                    f"particle {self.name!r} has no {_MISSING[name]}, which {what} needs; measure "
                    "it and add it where the particle is described"
                )
                raise CaseError(msg)


def plain_particle(particle: Particle) -> dict[str, Any]:
    """Return a particle as JSON holds it; 2500 and 2500.0 are the same number."""
    numbers = {
        name: float(value) if isinstance(value, int) else value
        for name, value in asdict(particle).items()
    }
    return numbers | {"size_classes": [[float(d), float(n)] for d, n in particle.size_classes]}


def particle_of(plain: Any) -> Particle:
    """Return the particle that `plain_particle` described.

    Raises
    ------
    TypeError, KeyError, ValueError
        If it described none.
    """
    if not isinstance(plain, Mapping):
        msg = f"particle = {plain!r} is no record of a particle"
        raise TypeError(msg)
    classes = tuple((float(d), float(n)) for d, n in plain["size_classes"])
    return Particle(**(dict(plain) | {"size_classes": classes}))
