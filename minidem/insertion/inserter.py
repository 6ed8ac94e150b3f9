"""What all insertion commands do: when, how many, which, and the bookkeeping."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from minidem.insertion.seeds import ParkMiller
from minidem.insertion.settings import Domain, Settings

__all__ = ["Flight", "Inserter", "NewParticles", "Present"]


@dataclass(frozen=True)
class Present:
    """The particles that are there.

    Attributes
    ----------
    position : (N, 3) ndarray
        m.
    radius : (N,) ndarray
        m.
    mass : (N,) ndarray or None
        kg; needed by ``mass_in_region`` only.
    """

    position: NDArray[np.float64]
    radius: NDArray[np.float64]
    mass: NDArray[np.float64] | None = None


@dataclass(frozen=True)
class Flight:
    """How particles of a stream move until they reach the insertion face.

    Attributes
    ----------
    origin : (n, 3) ndarray
        Place of insertion, m.
    start : int
        Step of insertion.
    release : (n,) ndarray of int
        Step at which they are set free.
    velocity : (3,) ndarray
        Velocity until then, m/s.
    final_velocity, final_omega : (n, 3) ndarray
        Velocity and spin from then on, m/s and rad/s.
    """

    origin: NDArray[np.float64]
    start: int
    release: NDArray[np.int64]
    velocity: NDArray[np.float64]
    final_velocity: NDArray[np.float64]
    final_omega: NDArray[np.float64]


@dataclass(frozen=True)
class NewParticles:
    """Particles to add, in LIGGGHTS' order of insertion.

    Attributes
    ----------
    position, velocity, omega : (n, 3) ndarray
        m, m/s, rad/s.
    radius, density, mass : (n,) ndarray
        m, kg/m3, kg.
    type : (n,) ndarray of int
        Material types, from 1.
    template : (n,) ndarray of int
        Index into the templates of the distribution (their groups).
    flight : Flight or None
        For streams.
    """

    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    omega: NDArray[np.float64]
    radius: NDArray[np.float64]
    density: NDArray[np.float64]
    mass: NDArray[np.float64]
    type: NDArray[np.int64]
    template: NDArray[np.int64]
    flight: Flight | None = None


@dataclass
class _Progress:
    """What changes while a command works."""

    next_step: int | None
    inserted: int = 0
    inserted_mass: float = 0.0
    every: int = 0
    per_event: float = 0.0
    number: int = 0
    mass: float = 0.0
    particle_rate: float = 0.0
    mass_rate: float = 0.0
    ready: bool = False
    exact: bool = True
    messages: list[str] = field(default_factory=list)


class Inserter(ABC):
    """An insertion command.

    Parameters
    ----------
    name : str
        Name of the fix, for messages.
    settings : Settings
        Common keywords.

    Notes
    -----
    The engine calls `setup` at the beginning of each run and `insert` at the step `next_step`.
    Lines for screen and log are collected in order; `take_messages` hands them out.
    """

    style = ""
    limited = True

    def __init__(self, name: str, settings: Settings) -> None:
        self.name = name
        self.settings = settings
        self.random = ParkMiller(settings.seed)
        self._progress = _Progress(settings.start, every=settings.every, exact=settings.exact)

    @property
    def next_step(self) -> int | None:
        """Step of the next insertion, None if there is none."""
        return self._progress.next_step

    @property
    def inserted(self) -> int:
        """Particles inserted so far."""
        return self._progress.inserted

    @property
    def inserted_mass(self) -> float:
        """Mass inserted so far in kg."""
        return self._progress.inserted_mass

    def take_messages(self) -> list[str]:
        """Return and forget the lines to print."""
        lines, self._progress.messages = self._progress.messages, []
        return lines

    def setup(self, dt: float, domain: Domain) -> None:
        """Prepare the first run; later calls do nothing.

        Parameters
        ----------
        dt : float
            Time step, s.
        domain : Domain
            The simulation box.

        Raises
        ------
        ValueError
            If keywords are missing or contradict each other.
        """
        if self._progress.ready:
            return
        self._progress.ready = True
        self.prepare(dt, domain)
        self._announce()

    def shift_steps(self, shift: int) -> None:
        """Follow a ``reset_timestep`` by `shift` steps."""
        if self._progress.next_step is not None:
            self._progress.next_step += shift

    def insert(self, step: int, present: Present, domain: Domain) -> NewParticles:
        """Choose and place the particles of this event.

        Parameters
        ----------
        step : int
            Present step; must be `next_step`.
        present : Present
            Particles that are there, periodic images near the box included.
        domain : Domain
            The simulation box.

        Returns
        -------
        NewParticles
            Possibly none.
        """
        progress = self._progress
        wanted = self.wanted(present, domain)
        exact = progress.exact
        if self._has_total() and progress.inserted + wanted >= progress.number:
            wanted = max(progress.number - progress.inserted, 0)
            exact = progress.exact = True
        self.divide(domain)
        if not exact:
            # The share of this process is all, but a number is drawn to round it.
            wanted = int(float(wanted) + self.random.uniform())
        chosen = self.settings.distribution.deal(wanted, exact=exact)
        if chosen.size == 0:
            self._nothing()
            return self.collect(chosen, np.empty((0, 3)), np.empty((0, 3)), step)
        if self._has_total() and progress.inserted + chosen.size > progress.number:
            self.warn(
                "INFO: Particle insertion: Number of particles to insert was slightly exceeded "
                "by random process"
            )
        position, velocity = self.place(chosen, present, domain)
        new = self.collect(chosen[: len(position)], position, velocity, step)
        self._tally(new, chosen.size, step)
        return new

    # -- what the commands differ in ----------------------------------------------------------

    @abstractmethod
    def prepare(self, dt: float, domain: Domain) -> None:
        """Check keywords and compute rates before the first run."""

    @abstractmethod
    def wanted(self, present: Present, domain: Domain) -> int:
        """Return how many particles this event should insert."""

    @abstractmethod
    def divide(self, domain: Domain) -> None:
        """Draw the random numbers with which LIGGGHTS finds the share of a process."""

    @abstractmethod
    def place(
        self, chosen: NDArray[np.int64], present: Present, domain: Domain
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return positions and velocities (n, 3) of those that found a place."""

    # -- for the commands ---------------------------------------------------------------------

    def warn(self, text: str) -> None:
        """Add a warning to the messages."""
        self._progress.messages.append(f"WARNING: {text}")

    def collect(
        self,
        chosen: NDArray[np.int64],
        position: NDArray[np.float64],
        velocity: NDArray[np.float64],
        step: int,
    ) -> NewParticles:
        """Return the particles as arrays; streams add how they fly."""
        del step
        templates = self.settings.distribution.templates
        return NewParticles(
            position=position,
            velocity=velocity,
            omega=np.tile(self.settings.omega, (len(position), 1)),
            radius=np.array([t.radius for t in templates])[chosen],
            density=np.array([t.density for t in templates])[chosen],
            mass=np.array([t.mass for t in templates])[chosen],
            type=np.array([t.type for t in templates], dtype=np.int64)[chosen],
            template=chosen,
        )

    def radii(self, chosen: NDArray[np.int64]) -> NDArray[np.float64]:
        """Return the radii of the chosen templates, m."""
        templates = self.settings.distribution.templates
        found: NDArray[np.float64] = np.array([t.radius for t in templates])[chosen]
        return found

    def rates(self, dt: float) -> None:
        """Compute total and number per event from nparticles or mass and the given rate."""
        s, progress = self.settings, self._progress
        mean = s.distribution.mean_mass
        if not s.number and not s.unlimited:
            if not s.mass:
                msg = f"{self.style}: give either 'nparticles' or 'mass' (a number or INF)"
                raise ValueError(msg)
            if s.mass / mean > 2.0e9:
                msg = f"{self.style}: mass {s.mass:g} kg means more than 2e9 particles"
                raise ValueError(msg)
        progress.number = s.number or self.number_of_mass(s.mass, mean)
        if not s.particle_rate and not s.mass_rate:
            msg = f"{self.style}: give either 'massrate' or 'particlerate'"
            raise ValueError(msg)
        progress.particle_rate = s.particle_rate or s.mass_rate / mean
        progress.mass_rate = s.mass_rate or s.particle_rate * mean
        progress.per_event = progress.particle_rate * (float(progress.every) * dt)
        if self._has_total():
            progress.mass = float(progress.number) * mean

    def number_of_mass(self, mass: float, mean: float) -> int:
        """Return the number of particles of a total mass."""
        return int(mass / mean)

    def by_rate(self) -> int:
        """Return the number of particles of one event of a constant rate."""
        progress = self._progress
        wanted = int(progress.per_event + self.random.uniform())
        if self._has_total() and progress.inserted + wanted > progress.number:
            wanted = progress.number - progress.inserted
        return wanted

    # -- bookkeeping --------------------------------------------------------------------------

    def _has_total(self) -> bool:
        return self.limited and not self.settings.unlimited

    def _nothing(self) -> None:
        progress = self._progress
        if progress.particle_rate > 0.0 or progress.mass_rate > 0.0:
            self.warn(
                "Particle insertion: Inserting no particle - check particle insertion settings"
            )
        if self._goes_on():
            self._later()
        else:
            progress.next_step = None

    def _goes_on(self) -> bool:
        progress = self._progress
        done = self._has_total() and progress.inserted >= progress.number
        return progress.every > 0 and not done

    def _later(self) -> None:
        if self._progress.next_step is not None:
            self._progress.next_step += self._progress.every

    def _tally(self, new: NewParticles, asked: int, step: int) -> None:
        progress = self._progress
        mass = 0.0
        for value in new.mass.tolist():
            mass += value
        progress.inserted += len(new.mass)
        progress.inserted_mass += mass
        if self.settings.verbose:
            progress.messages += [
                f"INFO: Particle insertion {self.name}: inserted {len(new.mass)} "
                f"particle templates (mass {mass:e}) at step {step}",
                f" - a total of {progress.inserted} particle templates "
                f"(mass {progress.inserted_mass:e}) inserted so far.",
            ]
        if len(new.mass) < asked:
            self.warn("Particle insertion: Less insertions than requested")
        if self._goes_on():
            self._later()
        else:
            progress.next_step = None

    def _announce(self) -> None:
        progress = self._progress
        head = f"INFO: Particle insertion {self.name}: "
        rate = (
            f"{progress.per_event:f} particles every {progress.every} steps - particle rate "
            f"{progress.particle_rate:f}, (mass rate {progress.mass_rate:e})"
        )
        if self._has_total():
            steps = 0
            if progress.number > progress.per_event:
                steps = int(float(progress.number) / progress.per_event) * progress.every
            progress.messages += [
                head + rate,
                f"      {progress.number} particles (mass {progress.mass:e}) within {steps} steps",
            ]
        elif progress.mass_rate > 0.0:
            progress.messages.append(head + rate)
        else:
            progress.messages.append(f"{head}inserting every {progress.every} steps")

    def state(self) -> dict[str, float]:
        """Return what a restart needs; all numbers are exact as float."""
        progress = self._progress
        return {
            "seed": float(self.random.state[0]),
            "saved": float(self.random.state[1]),
            "gauss": float(self.random.state[2]),
            "distribution_seed": float(self.settings.distribution.random.state[0]),
            "inserted": float(progress.inserted),
            "inserted_mass": progress.inserted_mass,
            "next_step": -1.0 if progress.next_step is None else float(progress.next_step),
        }

    def restore(self, state: dict[str, float]) -> None:
        """Go on from a state; call before `setup`."""
        self.random.state[:] = (state["seed"], state["saved"], state["gauss"])
        self.settings.distribution.random.reset(int(state["distribution_seed"]))
        self._progress.inserted = int(state["inserted"])
        self._progress.inserted_mass = state["inserted_mass"]
        following = int(state["next_step"])
        self._progress.next_step = None if following < 0 else following
