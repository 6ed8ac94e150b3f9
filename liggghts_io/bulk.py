"""A bulk solid as a person describes it, in a table or in a study file: units stand in the names.

`Bulk.particle` is the same in SI units, and has one size and one list of size classes however they
were given.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Annotated, Final, Literal

from pydantic import BaseModel, ConfigDict, Field, model_validator

from liggghts_io.materials import (
    MEASURED,
    POISSON_RATIO,
    YOUNGS_MODULUS,
    Particle,
    SizeClasses,
)
from liggghts_io.sizes import by_number, lognormal_classes, quantile_spread

QUANTILE_SHARES: Final = (0.3, 0.4, 0.3)
"""Swanson's shares of the 10, 50 and 90 % quantiles: they keep mean and spread of a quantity."""

NUMBER: Final = "number"
MOST_CLASSES: Final = 20
"""More classes cost templates in a script, and tell nothing more."""

_FAR: Final = 2.0
"""Factor between a Sauter diameter and that of a log-normal distribution through its quantiles."""
_MICRO: Final = 1e-6
_GRAM: Final = 1e-3

# The limits find a value in another unit (metres or millimetres for um, g/cm3 for kg/m3).
_Micrometres = Annotated[float, Field(ge=10.0, le=1e5)]
_Positive = Annotated[float, Field(gt=0.0)]


class Bulk(BaseModel):
    """A bulk solid as a person describes it.

    The size is `d32_um`, or follows from quantiles `d10_um`, `d50_um`, `d90_um`, or from a sieve
    table; a given `d32_um` goes before what the others would make of it.

    Attributes
    ----------
    name : str
    d32_um : float, optional
        Sauter diameter [um].
    d10_um, d50_um, d90_um : float, optional
        Quantiles of the diameter [um].
    quantiles_of : {"number", "mass"}
        What they are quantiles of: of the number of grains (d10,0 ..), as image analysis counts
        them, or of their mass (d10,3 ..), as laser diffraction and sieving weigh them.
    lognormal_classes : int, optional
        Classes of equal mass of a log-normal distribution through the quantiles; without it there
        are three classes at the quantiles themselves.
    sieve : tuple of (float, float)
        Diameter [um] and share of the mass of each class; shares in any unit.
    density_kg_m3 : float
        Density of a grain [kg/m3].
    youngs_modulus_pa, poisson_ratio : float
        Elastic constants [Pa], [-]; the engines take moduli from 5e6 to 1e9 Pa.
    flow_flat_g_s, flow_glued_g_s : float, optional
        Mass flow of the funnel used with the flat and with the glued conveyor plate [g/s]; the
        plate impact takes the first.
    impact_mass_g : float, optional
        Mass poured in the plate impact [g].
    sizes : {"one", "measured"}, optional
        Of the simulated grains: all of Sauter diameter, or as measured; without it as measured,
        if they were.
    coarse_graining : float
        Diameter of the simulated over that of the real grains; masses and flows stay.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    name: Annotated[str, Field(min_length=1, max_length=80)]
    d32_um: _Micrometres | None = None
    d10_um: _Micrometres | None = None
    d50_um: _Micrometres | None = None
    d90_um: _Micrometres | None = None
    quantiles_of: Literal["number", "mass"] = NUMBER
    lognormal_classes: Annotated[int, Field(ge=2, le=MOST_CLASSES)] | None = None
    sieve: tuple[tuple[_Micrometres, _Positive], ...] = ()
    density_kg_m3: Annotated[float, Field(ge=10.0, le=25000.0)]
    youngs_modulus_pa: Annotated[float, Field(ge=5e6, le=1e9)] = YOUNGS_MODULUS
    poisson_ratio: Annotated[float, Field(ge=0.0, lt=0.5)] = POISSON_RATIO
    flow_flat_g_s: _Positive | None = None
    flow_glued_g_s: _Positive | None = None
    impact_mass_g: _Positive | None = None
    sizes: Literal["one", "measured"] | None = None
    coarse_graining: Annotated[float, Field(ge=1.0, le=10.0)] = 1.0

    @model_validator(mode="after")
    def _check(self) -> Bulk:
        given = self.quantiles_um
        if 0 < len(given) < 3:
            msg = "d10_um, d50_um and d90_um belong together; give all three or none"
            raise ValueError(msg)
        if given and not given[0] < given[1] < given[2]:
            msg = f"quantiles {given[0]:g}, {given[1]:g}, {given[2]:g} um must rise"
            raise ValueError(msg)
        if given and self.sieve:
            msg = "quantiles and a sieve table describe the same; give one of them"
            raise ValueError(msg)
        if not given and (self.lognormal_classes or "quantiles_of" in self.model_fields_set):
            word = "lognormal_classes" if self.lognormal_classes else "quantiles_of"
            msg = f"{word} says more about d10_um, d50_um and d90_um, which are not given"
            raise ValueError(msg)
        if self.sizes == MEASURED and not given and not self.sieve:
            msg = "sizes = 'measured', and none were; give d10_um, d50_um and d90_um, or sieve"
            raise ValueError(msg)
        if self.d32_um is None and not given and not self.sieve:
            msg = "no size; give d32_um, or d10_um, d50_um and d90_um, or sieve"
            raise ValueError(msg)
        if self.sieve:
            self._check_sieve()
        if self.d32_um is not None and given:
            _check_sauter(self.d32_um, given, self.quantiles_of)
        return self

    def _check_sieve(self) -> None:
        sizes = [diameter for diameter, _ in self.sieve]
        if len(set(sizes)) < len(sizes):
            msg = "sieve: a diameter appears twice; give each class once"
            raise ValueError(msg)
        if self.d32_um is not None and not min(sizes) <= self.d32_um <= max(sizes):
            msg = f"d32_um = {self.d32_um:g} lies outside the sieve classes; leave it out"
            raise ValueError(msg)

    @property
    def quantiles_um(self) -> tuple[float, ...]:
        """Those of the quantiles that were given [um]."""
        return tuple(q for q in (self.d10_um, self.d50_um, self.d90_um) if q is not None)

    @property
    def particle(self) -> Particle:
        """The same in SI units."""

        def kilograms(grams: float | None) -> float | None:
            return None if grams is None else grams * _GRAM

        classes = self._size_classes()
        return Particle(
            name=self.name,
            d32_m=self._sauter_um() * _MICRO,
            density=self.density_kg_m3,
            youngs_modulus=self.youngs_modulus_pa,
            poisson_ratio=self.poisson_ratio,
            size_classes=classes,
            flow_flat_kg_s=kilograms(self.flow_flat_g_s),
            flow_glued_kg_s=kilograms(self.flow_glued_g_s),
            impact_mass_kg=kilograms(self.impact_mass_g),
            sizes=self.sizes or "",
            coarse_graining=self.coarse_graining,
        )

    def _sauter_um(self) -> float:
        if self.d32_um is not None:
            return self.d32_um
        if self.sieve:
            return sauter_of_masses(self.sieve)
        low, median, high = self.quantiles_um
        return sauter_of_quantiles(low, median, high, self.quantiles_of)

    def _size_classes(self) -> SizeClasses:
        if self.sieve:
            return by_number([(d * _MICRO, mass) for d, mass in self.sieve])
        if not self.quantiles_um:
            return ()
        quantiles = [q * _MICRO for q in self.quantiles_um]
        if self.lognormal_classes:
            spread = quantile_spread(quantiles[0], quantiles[2])
            shift = 0.0 if self.quantiles_of == NUMBER else -3.0 * spread**2
            return lognormal_classes(quantiles[1] * math.exp(shift), spread, self.lognormal_classes)
        classes = tuple(zip(quantiles, QUANTILE_SHARES, strict=True))
        return classes if self.quantiles_of == NUMBER else by_number(classes)


def _check_sauter(d32: float, quantiles: Sequence[float], of: str) -> None:
    """Refuse a Sauter diameter that does not belong to quantiles; all in one unit.

    Two sides are certain, whatever the distribution. 1/d32 is the mean of 1/d by mass, so that with
    quantiles of the mass it is at least 0.1/d10 + 0.4/d50 + 0.4/d90: d32 has a largest value. d32
    is the mean of d by surface, which is at least that by number, so that with quantiles of the
    number it is at least 0.4 d10 + 0.4 d50 + 0.1 d90: d32 has a smallest value. The other sides are
    open, as single fines or coarse grains may do anything; there a factor of `_FAR` from the
    log-normal distribution is taken for a slip.

    Raises
    ------
    ValueError
    """
    low, median, high = quantiles
    usual = sauter_of_quantiles(low, median, high, of)
    least, most = usual / _FAR, usual * _FAR
    if of == NUMBER:
        least = 0.4 * low + 0.4 * median + 0.1 * high
    else:
        most = 1.0 / (0.1 / low + 0.4 / median + 0.4 / high)
    if not least <= d32 <= most:
        msg = (
            f"d32_um = {d32:g} does not belong to quantiles {low:g}, {median:g}, {high:g} um of "
            f"the {of}, of which it lies from {least:.4g} to {most:.4g} um; correct one of them, "
            "say quantiles_of = 'mass' or 'number', or leave d32_um out"
        )
        raise ValueError(msg)


def sauter_of_masses(classes: Sequence[tuple[float, float]]) -> float:
    """Return the Sauter diameter of mass classes, sum(m) / sum(m / d), in the unit of `d`.

    Examples
    --------
    >>> sauter_of_masses([(1.0, 1.0), (2.0, 2.0)])
    1.5
    """
    return sum(mass for _, mass in classes) / sum(mass / d for d, mass in classes)


def sauter_of_quantiles(d10: float, d50: float, d90: float, of: str = NUMBER) -> float:
    """Return the Sauter diameter of a log-normal distribution, in the unit of `d50`.

    Parameters
    ----------
    d10, d50, d90 : float
        Quantiles.
    of : str
        "number": d32 = d50 exp(5/2 s^2), "mass": d32 = d50 exp(-s^2 / 2), both with
        s = ln(d90 / d10) / (2 z), z = 1.2816 the 90 % quantile of the normal distribution.

    Notes
    -----
    The third over the second moment of the log-normal distribution. Not checked: that d50 is the
    geometric mean of d10 and d90, as it is for this distribution.
    """
    spread = quantile_spread(d10, d90)
    return d50 * math.exp((2.5 if of == NUMBER else -0.5) * spread**2)
