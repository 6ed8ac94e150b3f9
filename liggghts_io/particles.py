"""Bulk solids as people describe them: rows of a CSV table, or one table of a study file.

Units stand in the names of the columns; `Bulk.particle` is the same in SI units.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from pathlib import Path
from statistics import NormalDist
from typing import Annotated, Any, Final

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from liggghts_io.errors import CaseError, nearest
from liggghts_io.materials import POISSON_RATIO, YOUNGS_MODULUS, Particle, SizeClasses

QUANTILE_SHARES: Final = (0.3, 0.4, 0.3)
"""Swanson's shares of the 10, 50 and 90 % quantiles: they keep mean and spread of a quantity."""

NAME_COLUMN: Final = "particle"
DESCRIPTIVE: Final = ("circularity", "source", "remark")
"""Columns of a table that are for readers only."""

_MICRO: Final = 1e-6
_GRAM: Final = 1e-3
_Z90: Final = NormalDist().inv_cdf(0.9)

# The limits find a value in another unit (metres or millimetres for um, g/cm3 for kg/m3).
_Micrometres = Annotated[float, Field(ge=10.0, le=1e5)]
_Positive = Annotated[float, Field(gt=0.0)]


class Bulk(BaseModel):
    """A bulk solid as a person describes it.

    The size is `d32_um`, or follows from number quantiles `d10_um`, `d50_um`, `d90_um`, or from a
    sieve table; a given `d32_um` goes before what the others would make of it.

    Attributes
    ----------
    name : str
    d32_um : float, optional
        Sauter diameter [um].
    d10_um, d50_um, d90_um : float, optional
        Number quantiles of the diameter [um], as image analysis of grains counts them.
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
    """

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    name: Annotated[str, Field(min_length=1, max_length=80)]
    d32_um: _Micrometres | None = None
    d10_um: _Micrometres | None = None
    d50_um: _Micrometres | None = None
    d90_um: _Micrometres | None = None
    sieve: tuple[tuple[_Micrometres, _Positive], ...] = ()
    density_kg_m3: Annotated[float, Field(ge=10.0, le=25000.0)]
    youngs_modulus_pa: Annotated[float, Field(ge=5e6, le=1e9)] = YOUNGS_MODULUS
    poisson_ratio: Annotated[float, Field(ge=0.0, lt=0.5)] = POISSON_RATIO
    flow_flat_g_s: _Positive | None = None
    flow_glued_g_s: _Positive | None = None
    impact_mass_g: _Positive | None = None

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
            msg = "number quantiles and a sieve table describe the same; give one of them"
            raise ValueError(msg)
        if self.d32_um is None and not given and not self.sieve:
            msg = "no size; give d32_um, or d10_um, d50_um and d90_um, or sieve"
            raise ValueError(msg)
        if self.sieve:
            self._check_sieve()
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
        """Those of the number quantiles that were given [um]."""
        return tuple(q for q in (self.d10_um, self.d50_um, self.d90_um) if q is not None)

    @property
    def particle(self) -> Particle:
        """The same in SI units."""

        def kilograms(grams: float | None) -> float | None:
            return None if grams is None else grams * _GRAM

        return Particle(
            name=self.name,
            d32_m=self._sauter_um() * _MICRO,
            density=self.density_kg_m3,
            youngs_modulus=self.youngs_modulus_pa,
            poisson_ratio=self.poisson_ratio,
            size_classes=self._size_classes(),
            flow_flat_kg_s=kilograms(self.flow_flat_g_s),
            flow_glued_kg_s=kilograms(self.flow_glued_g_s),
            impact_mass_kg=kilograms(self.impact_mass_g),
        )

    def _sauter_um(self) -> float:
        if self.d32_um is not None:
            return self.d32_um
        if self.sieve:
            return sauter_of_masses(self.sieve)
        low, median, high = self.quantiles_um
        return sauter_of_quantiles(low, median, high)

    def _size_classes(self) -> SizeClasses:
        if self.sieve:
            numbers = [(d * _MICRO, mass / d**3) for d, mass in sorted(self.sieve)]
            total = sum(count for _, count in numbers)
            return tuple((d, count / total) for d, count in numbers)
        quantiles = [q * _MICRO for q in self.quantiles_um]
        return tuple(zip(quantiles, QUANTILE_SHARES, strict=True)) if quantiles else ()


def sauter_of_masses(classes: Sequence[tuple[float, float]]) -> float:
    """Return the Sauter diameter of mass classes, sum(m) / sum(m / d), in the unit of `d`.

    Examples
    --------
    >>> sauter_of_masses([(1.0, 1.0), (2.0, 2.0)])
    1.5
    """
    return sum(mass for _, mass in classes) / sum(mass / d for d, mass in classes)


def sauter_of_quantiles(d10: float, d50: float, d90: float) -> float:
    """Return the Sauter diameter of a log-normal distribution of numbers, in the unit of `d50`.

    d32 = d50 exp(5/2 s^2) with s = ln(d90 / d10) / (2 z), z = 1.2816 the 90 % quantile of the
    normal distribution: the moments of the log-normal distribution, whose third over its second
    is the Sauter diameter. Not checked: that d50 is the geometric mean of d10 and d90, as it is
    for this distribution.
    """
    spread = math.log(d90 / d10) / (2.0 * _Z90)
    return d50 * math.exp(2.5 * spread**2)


def read_particles(path: Path) -> dict[str, Particle]:
    """Read a table of particles; see `read_bulks`."""
    return {name: bulk.particle for name, bulk in read_bulks(path).items()}


def read_bulks(path: Path) -> dict[str, Bulk]:
    """Read a table of bulk solids.

    Parameters
    ----------
    path : Path
        CSV file: comment lines begin with `#`, then a head with the column `particle` and those
        of `Bulk`. An empty cell or a column left out is a value that was not given. A cell of
        `sieve` holds the classes as `diameter:mass` with spaces between.

    Returns
    -------
    dict of str to Bulk
        By name, in the order of the file.

    Raises
    ------
    CaseError
        With file, line, column, value and remedy.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as err:
        reason = getattr(err, "strerror", None) or "not a text in UTF-8"
        msg = f"{path}: cannot be read as a table of particles ({reason}); save it as CSV in UTF-8"
        raise CaseError(msg) from err
    rows = [
        (number, [cell.strip() for cell in next(csv.reader([line], skipinitialspace=True))])
        for number, line in enumerate(text.splitlines(), start=1)
        if line.strip() and not line.startswith("#")
    ]
    if not rows:
        msg = f"{path}: holds no table; begin with a head such as {NAME_COLUMN},d32_um,..."
        raise CaseError(msg)
    head = _head(path, rows[0][1])
    found: dict[str, Bulk] = {}
    for number, cells in rows[1:]:
        bulk = _bulk(f"{path}:{number}", head, cells)
        if bulk.name in found:
            msg = f"{path}:{number}: particle {bulk.name!r} stands in a row above; rename one"
            raise CaseError(msg)
        found[bulk.name] = bulk
    return found


def _head(path: Path, columns: list[str]) -> list[str]:
    known = [NAME_COLUMN, *(name for name in Bulk.model_fields if name != "name"), *DESCRIPTIVE]
    if NAME_COLUMN not in columns:
        separator = " (are the columns separated by commas?)" if len(columns) == 1 else ""
        msg = f"{path}: no column {NAME_COLUMN!r} in the head {','.join(columns)!r}{separator}"
        raise CaseError(msg)
    for column in columns:
        if column not in known:
            msg = f"{path}: unknown column {column!r}{nearest(column, known)}"
            raise CaseError(msg)
        if columns.count(column) > 1:
            msg = f"{path}: column {column!r} appears twice; remove one"
            raise CaseError(msg)
    return columns


def _bulk(place: str, head: list[str], cells: list[str]) -> Bulk:
    if len(cells) != len(head):
        msg = (
            f"{place}: {len(cells)} cells under a head of {len(head)} columns; write decimals with "
            "a point, and names that hold a comma in quotes"
        )
        raise CaseError(msg)
    values: dict[str, Any] = {
        column: cell for column, cell in zip(head, cells, strict=True) if cell
    }
    for column in DESCRIPTIVE:
        values.pop(column, None)
    if "sieve" in values:
        values["sieve"] = [pair.split(":") for pair in values["sieve"].split()]
    name = values.pop(NAME_COLUMN, "")
    try:
        return Bulk(name=name, **values)
    except ValidationError as err:
        msg = f"{place}: particle {name!r}: {_reason(err)}"
        raise CaseError(msg) from err


def _reason(err: ValidationError) -> str:
    """Turn the first finding of pydantic into column, value and what is wrong."""
    found = err.errors(include_url=False)[0]
    message = str(found["msg"]).removeprefix("Value error, ")
    if not found["loc"]:
        return message
    column = str(found["loc"][0])
    if found["type"] == "missing" and column != "sieve":
        return f"{column} is missing; add the column or fill the cell"
    if column == "sieve":
        return f"sieve: {found['input']!r}: {message}; write it as '1400:0.3 1600:0.7'"
    return f"{column} = {found['input']!r}: {message} (the unit is in the column's name)"


def particle_named(name: str, table: Path) -> Particle:
    """Return the particle of that name from a table.

    Raises
    ------
    CaseError
        For an unknown name, with the nearest known one, or a table that cannot be read.
    """
    return bulk_named(name, table).particle


def bulk_named(name: str, table: Path) -> Bulk:
    """Return the bulk of that name from a table.

    Raises
    ------
    CaseError
        For an unknown name, with the nearest known one, or a table that cannot be read.
    """
    bulks = read_bulks(table)
    if name not in bulks:
        msg = f"{table}: unknown particle {name!r}{nearest(name, list(bulks))}"
        raise CaseError(msg)
    return bulks[name]
