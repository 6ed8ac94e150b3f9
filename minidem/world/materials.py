"""Material values that a script has given."""

from __future__ import annotations

import numpy as np

from minidem.errors import InputError, MissingValueError, suggest
from minidem.record import field, record
from minidem.world.state import Floats

__all__ = ["Materials"]

_SHOWN = 4  # values in a message
_SAME_AS = {"peratomtype": "vector", "peratomtypepair": "matrix"}
"""Styles that LIGGGHTS takes for one that it asks for."""
_LIKE = 0.87  # names of values are alike; those less alike are not meant for each other


@record
class Materials:
    """Values given with ``fix property/global``, by name.

    Attributes
    ----------
    values : dict
        Name to array: one value, one per type, or one per pair of types.
    styles : dict
        Name to the style in which it was given: scalar, vector, peratomtype, matrix or
        peratomtypepair; none for those that a check of a script puts in.
    soft, hard : bool
        ``soft_particles yes`` and ``hard_particles yes``: Young's modulus out of the usual range.
    units : str
        si, cgs, lj, micro or nano; lj as long as no ``units`` says otherwise, as in LIGGGHTS.
    """

    values: dict[str, Floats] = field(default_factory=dict)
    styles: dict[str, str] = field(default_factory=dict)
    soft: bool = False
    hard: bool = False
    units: str = "lj"

    def per_type(self, name: str, types: int, model: str) -> Floats:
        """Return a property per type, shape (types,).

        Raises
        ------
        InputError
            If it is missing or has the wrong length.
        """
        found = self.of(name, model, f"peratomtype {_values(types)}")
        if found.size != types:
            msg = f"{name} has {found.size} values, but there are {types} atom types"
            raise InputError(msg)
        return found

    def per_pair(self, name: str, types: int, model: str) -> Floats:
        """Return a property per pair of types, shape (types, types).

        Raises
        ------
        InputError
            If it is missing, has the wrong length or is not symmetric.
        """
        found = self.of(name, model, f"peratomtypepair {types} {_values(types * types)}")
        if found.size != types * types:
            msg = f"{name} has {found.size} values, but {types} atom types need {types * types}"
            raise InputError(msg)
        return found.reshape(types, types)

    def of(self, name: str, model: str, form: str = "scalar VALUE") -> Floats:
        """Return the values of a property as they were given; `form` is how a script does so.

        Raises
        ------
        MissingValueError
            If it is missing.
        InputError
            If it was given in another style.
        """
        if name not in self.values:
            near = suggest(name, self.values, _LIKE).removeprefix("; d")
            msg = (
                "Could not locate a fix/property storing value(s) for "
                f"{name} as requested by {model}.{f' D{near}' if near else ''} Add "
                f"'fix ID all property/global {name} {form}'"
            )
            raise MissingValueError(msg, name)
        wanted = form.split()[0]
        if self.styles.get(name, wanted) not in (wanted, _SAME_AS.get(wanted)):
            msg = (
                f"{wanted} style required for fix property/global variable {name} for usage with "
                f"{model}; write 'fix ID all property/global {name} {form}'"
            )
            raise InputError(msg)
        return self.values[name]

    def check(self) -> None:
        """Apply the sanity limits of LIGGGHTS.

        Raises
        ------
        InputError
            With the words of LIGGGHTS.
        """
        low, high = {"si": (5e6, 1e9), "cgs": (5e7, 1e10)}.get(self.units, (-np.inf, np.inf))
        label = self.units.upper()
        for young in self.values.get("youngsModulus", np.zeros(0)).ravel():
            if young < low and not self.soft:
                msg = (
                    f"youngsModulus >= {low:.0e} required for {label} units "
                    "(use command 'soft_particles yes' to override)"
                )
                raise InputError(msg)
            if young > high and not self.hard:
                msg = (
                    f"youngsModulus <= {high:.0e} required for {label} units "
                    "(use command 'hard_particles yes' to override)"
                )
                raise InputError(msg)
        for nu in self.values.get("poissonsRatio", np.zeros(0)).ravel():
            if not 0.0 <= nu <= 0.5:
                msg = "0 <= poissonsRatio <= 0.5 required"
                raise InputError(msg)
        for e in self.values.get("coefficientRestitution", np.ones(1)).ravel():
            if not 0.05 < e <= 1.0:
                msg = "0.05 < coefficientRestitution <= 1 required"
                raise InputError(msg)


def _values(count: int) -> str:
    """Return the words of values, the first few of many."""
    return " ".join(["VALUE"] * min(count, _SHOWN)) + (" ..." if count > _SHOWN else "")
