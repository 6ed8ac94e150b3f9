"""Bookkeeping of an insertion command: counters, schedule and messages."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from minidem.errors import InputError
from minidem.insertion.settings import Settings
from minidem.record import field, record

__all__ = ["Progress"]


@record
class Progress:
    """What changes while a command works.

    Attributes
    ----------
    name : str
        Name of the fix.
    next_step : int or None
        Step of the next event.
    inserted, inserted_mass : int and float
        Done so far; kg.
    every : int
        Steps between events, 0 for one event only.
    per_event : float
        Mean number of particles of an event.
    total : bool
        Whether insertion ends at `number` particles.
    number, mass : int and float
        To insert in all; kg.
    particle_rate, mass_rate : float
        1/s and kg/s.
    ready : bool
        Whether the first run is prepared.
    exact : bool
        Whether the number of each event is met exactly.
    messages : list of str
        Lines to print.
    """

    name: str
    next_step: int | None
    inserted: int = 0
    inserted_mass: float = 0.0
    every: int = 0
    per_event: float = 0.0
    total: bool = False
    number: int = 0
    mass: float = 0.0
    particle_rate: float = 0.0
    mass_rate: float = 0.0
    ready: bool = False
    exact: bool = True
    messages: list[str] = field(default_factory=list)

    def warn(self, text: str) -> None:
        """Add a warning to the messages."""
        self.messages.append(f"WARNING: {text}")

    def count_rates(self, settings: Settings, number: int, dt: float, style: str) -> None:
        """Compute what an event inserts from the given rate.

        Parameters
        ----------
        settings : Settings
            Keywords.
        number : int
            Particles to insert in all, 0 if unlimited.
        dt : float
            Time step, s.
        style : str
            For messages.
        """
        mean = settings.distribution.mean_mass
        if not settings.particle_rate and not settings.mass_rate:
            msg = f"{style}: give either 'massrate' or 'particlerate'"
            raise InputError(msg)
        self.number = number
        self.particle_rate = settings.particle_rate or settings.mass_rate / mean
        self.mass_rate = settings.mass_rate or settings.particle_rate * mean
        self.per_event = self.particle_rate * (float(self.every) * dt)
        if self.total:
            self.mass = float(number) * mean

    def advance(self) -> None:
        """Schedule the next event, if there is one."""
        done = self.total and self.inserted >= self.number
        if self.every > 0 and not done and self.next_step is not None:
            self.next_step += self.every
        else:
            self.next_step = None

    def nothing(self) -> None:
        """Book an event that inserts nothing."""
        if self.particle_rate > 0.0 or self.mass_rate > 0.0:
            self.warn(
                "Particle insertion: Inserting no particle - check particle insertion settings"
            )
        self.advance()

    def tally(self, masses: NDArray[np.float64], asked: int, step: int, *, verbose: bool) -> None:
        """Book an event.

        Parameters
        ----------
        masses : (n,) ndarray
            Masses of the inserted particles, kg.
        asked : int
            How many should have been inserted.
        step : int
            Present step.
        verbose : bool
            Whether to print a line.
        """
        mass = 0.0
        for value in masses.tolist():
            mass += value
        self.inserted += len(masses)
        self.inserted_mass += mass
        if verbose:
            self.messages += [
                f"INFO: Particle insertion {self.name}: inserted {len(masses)} "
                f"particle templates (mass {mass:e}) at step {step}",
                f" - a total of {self.inserted} particle templates "
                f"(mass {self.inserted_mass:e}) inserted so far.",
            ]
        if len(masses) < asked:
            self.warn("Particle insertion: Less insertions than requested")
        self.advance()

    def announce(self) -> None:
        """Print what will be inserted."""
        head = f"INFO: Particle insertion {self.name}: "
        rate = (
            f"{self.per_event:f} particles every {self.every} steps - particle rate "
            f"{self.particle_rate:f}, (mass rate {self.mass_rate:e})"
        )
        if self.total:
            steps = 0
            if self.number > self.per_event:
                steps = int(float(self.number) / self.per_event) * self.every
            self.messages += [
                head + rate,
                f"      {self.number} particles (mass {self.mass:e}) within {steps} steps",
            ]
        elif self.mass_rate > 0.0:
            self.messages.append(head + rate)
        else:
            self.messages.append(f"{head}inserting every {self.every} steps")
