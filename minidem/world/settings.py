"""Settings of a script that are a few numbers each."""

from __future__ import annotations

from collections.abc import Callable

from minidem.errors import InputError
from minidem.record import field, record
from minidem.words import Words

__all__ = ["UNITS", "USUAL", "Neighbor", "PairStyle", "Schedule", "Sorting", "Thermo"]

UNITS = {
    "si": (1e-8, 0.001), "cgs": (1e-8, 0.1), "lj": (5e-3, 0.3), "micro": (2.0, 0.1),
    "nano": (0.00045, 0.1),
}  # fmt: skip
"""Time step and skin that ``units`` sets."""

_NEVER = 2**62  # a step that no run reaches
USUAL = ("step", "atoms", "ke", "cpu")
"""Columns of thermo output that no script has chosen."""


@record
class Sorting:
    """``atom_modify sort``: how LIGGGHTS sorts its particles in space now and then.

    It is the order of lines in dumps, of ids after `delete_atoms`, and of chance.

    Attributes
    ----------
    every : int
        Steps after which particles are sorted when lists are made anew, 0 for never.
    size : float
        Least size of bins as the script has it, m; 0 for half the cutoff of neighbours.
    bin : float
        Least size of bins in this run, m.
    due : int
        Step from which on particles are sorted at the next new lists.
    """

    every: int = 1000
    size: float = 0.0
    bin: float = 0.0
    due: int = 0


@record
class Neighbor:
    """``neighbor`` and ``neigh_modify``.

    Attributes
    ----------
    skin : float
        m.
    delay, every : int
        Steps.
    check : bool
        Rebuild only if a particle moved half a skin.
    reach : float
        ``contact_distance_factor``.
    no_types, no_groups : list of (int, int)
        Pairs of types, from 1, and of bits of groups whose particles do not see each other.
    page, one : int
        Sizes of LIGGGHTS' lists; here they grow as needed, and are only checked.
    before : dict of str to int
        Of ``page`` and ``one`` what they were before they were given last.
    """

    skin: float = 0.3
    delay: int = 10
    every: int = 1
    check: bool = True
    reach: float = 1.0
    no_types: list[tuple[int, int]] = field(default_factory=list)
    no_groups: list[tuple[int, int]] = field(default_factory=list)
    page: int = 100_000
    one: int = 2000
    before: dict[str, int] = field(default_factory=dict)


@record
class PairStyle:
    """``pair_style gran``.

    Attributes
    ----------
    switches : list of int or None
        The model, see `minidem.kernels.contact.records.Switches`; None before the command.
    covered : list of range
        Atom types, from 1, whose pairs with themselves a ``pair_coeff`` behind it names.
    given : int
        How often the command was given.
    hybrid : bool
        Whether ``gran`` stands behind ``hybrid``, so that ``pair_coeff`` has to name it.
    """

    switches: list[int] | None = None
    covered: list[range] = field(default_factory=list)
    given: int = 0
    hybrid: bool = False

    def covers(self, types: int) -> bool:
        """Tell whether every type from 1 to `types` is covered."""
        reached = 1
        for one in sorted(self.covered, key=lambda one: one.start):
            if one.start <= reached:
                reached = max(reached, one.stop)
        return reached > types


@record
class Schedule:
    """When something is written: every so many steps, or at steps that a variable names.

    Attributes
    ----------
    every : int
        Interval in steps, 0 for never.
    variable : str
        Equal-style variable that gives the next step, instead of `every`; empty for none.
    due : int
        The next step that it gave.
    """

    every: int = 0
    variable: str = ""
    due: int = _NEVER

    @classmethod
    def read(cls, words: Words, *, least: int = 1) -> Schedule:
        """Read an interval of `least` steps or more, or ``v_NAME``."""
        if words.peek().startswith("v_"):
            return cls(variable=words.variable())
        return cls(words.interval(least=least))

    def asked(self) -> tuple[str, ...]:
        """Return the names of its variables."""
        return (self.variable,) if self.variable else ()

    def next_step(self, step: int) -> int:
        """Return the first step after `step`."""
        if self.variable:
            return self.due
        return (step // self.every + 1) * self.every if self.every else _NEVER

    def is_multiple(self, step: int) -> bool:
        """Tell whether a step is a multiple of the interval; if there is one."""
        return self.every > 0 and step % self.every == 0

    def plan(self, ask: Callable[[str], float], step: int, what: str) -> None:
        """Ask the variable, if there is one, for the step after `step`.

        Raises
        ------
        InputError
            If it gives none that is later.
        """
        if not self.variable:
            return
        value = ask(self.variable)
        self.due = int(value) if abs(value) < _NEVER else _NEVER
        if not self.due > step:
            msg = (
                f"{what}: variable '{self.variable}' gives step {value:g}, which is not after the "
                f"present one, {step}; see logfreq, stride and stagger"
            )
            raise InputError(msg)


@record
class Thermo:
    """``thermo``, ``thermo_style`` and ``thermo_modify``.

    Attributes
    ----------
    schedule : Schedule
        When a line is written besides the first and the last step.
    columns : tuple of str
        What is written.
    custom : bool
        Whether the script has chosen them; else a box that grows shows its volume too.
    several : bool
        Whether a snapshot takes several lines (``line multi``).
    lost : str
        What a lost particle means: error, warn or ignore, see `minidem.run.losses`.
    warned : bool
        Whether ``warn`` has warned already; it does so once.
    norm : bool or None
        Whether sums are divided by the number of particles; None for the default of the units.
    flush, modified : bool
        As given; `modified` until the next ``thermo_style``.
    marks : dict
        By keyword, what was done and the clock, s, when its pace was last asked for.
    """

    schedule: Schedule = field(default_factory=Schedule)
    columns: tuple[str, ...] = USUAL
    custom: bool = False
    several: bool = False
    lost: str = "ignore"
    warned: bool = False
    norm: bool | None = None
    modified: bool = False
    flush: bool = False
    marks: dict[str, tuple[float, float]] = field(default_factory=dict)
