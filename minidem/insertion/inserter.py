"""What all insertion commands do: when, how many, which, and the bookkeeping."""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np
from numpy.typing import NDArray

from minidem.errors import InputError
from minidem.insertion.particles import NewParticles, Present
from minidem.insertion.progress import Progress
from minidem.insertion.seeds import ParkMiller
from minidem.insertion.settings import Domain, Settings
from minidem.kernels.columns import KEPT_NORMAL, KEPT_READY, SEED
from minidem.kernels.insertion.grid import count_inside
from minidem.memory import check_room

__all__ = ["Inserter"]


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
    ordered = False
    """Whether particles have to come in the order of output, in which sums are made."""

    def __init__(self, name: str, settings: Settings) -> None:
        self.name = name
        self.settings = settings
        self.random = ParkMiller(settings.seed)
        self._overlooked = False
        self._progress = Progress(
            name, settings.start, every=settings.every,
            total=self.limited and not settings.unlimited, exact=settings.exact,
        )  # fmt: skip
        self._restored: dict[str, float] | None = None

    @property
    def flight_velocity(self) -> NDArray[np.float64] | None:
        """Velocity of particles on their way to a face, (3,) in m/s; None if they have none."""
        return None

    @property
    def next_step(self) -> int | None:
        """Step of the next insertion, None if there is none."""
        return self._progress.next_step

    @property
    def every(self) -> int:
        """Steps between insertions."""
        return self._progress.every

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
        InputError
            If keywords are missing or contradict each other.
        """
        if self._progress.ready:
            return
        self._progress.ready = True
        self.prepare(dt, domain)
        self._progress.announce()
        if self._restored is not None:
            self.apply_state(self._restored)
            self._restored = None

    def shift_steps(self, shift: int) -> None:
        """Follow a ``reset_timestep`` by `shift` steps."""
        if self._progress.next_step is not None:
            self._progress.next_step += shift
        if self._restored is not None and self._restored["next_step"] >= 0:
            self._restored["next_step"] += shift

    def insert(self, step: int, present: Present, domain: Domain) -> NewParticles:
        """Choose and place the particles of this event.

        Parameters
        ----------
        step : int
            Present step; must be `next_step`.
        present : Present
            Particles that are there, and their periodic images near the box.
        domain : Domain
            The simulation box.

        Returns
        -------
        NewParticles
            Possibly none.

        Raises
        ------
        ResourceError
            If there is no memory for them.
        """
        progress = self._progress
        wanted = self.wanted(present, domain)
        exact = progress.exact
        if progress.total and progress.inserted + wanted >= progress.number:
            wanted = max(progress.number - progress.inserted, 0)
            exact = progress.exact = True
        self.divide(domain)
        if not exact:
            # The share of this process is all, but a number is drawn to round it.
            wanted = int(float(wanted) + self.random.uniform())
        check_room(wanted, len(present.position), f"fix {self.name}")
        chosen = self.settings.distribution.deal(wanted, exact=exact)
        if chosen.size == 0:
            progress.nothing()
            return self.collect(chosen, np.empty((0, 3)), np.empty((0, 3)), step)
        if progress.total and progress.inserted + chosen.size > progress.number:
            progress.warn(
                "INFO: Particle insertion: Number of particles to insert was slightly exceeded "
                "by random process"
            )
        there = present.with_images()
        position, velocity = self.place(chosen, there, domain)
        new = self.collect(chosen[: len(position)], position, velocity, step)
        self._say_overlooked(there, new)
        progress.tally(new.mass, chosen.size, step, verbose=self.settings.verbose)
        return new

    def _say_overlooked(self, there: Present, new: NewParticles) -> None:
        """Warn, once, of new particles in much larger ones, which LIGGGHTS does not see."""
        if self._overlooked or not self.settings.check_overlap:
            return
        far = 3.0 * self.settings.distribution.max_radius  # nearer ones are in the next bin
        large = there.radius > far
        if not large.any():
            return
        count = count_inside(there.position[large], there.radius[large], new.position, new.radius)
        if count:
            self._overlooked = True
            self._progress.warn(
                f"fix {self.name}: {count} of {len(new.radius)} new particles overlap one more "
                "than three times as large as the largest of them; LIGGGHTS, which does not look "
                "that far, puts them there, too (said once)"
            )

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

    def collect(
        self,
        chosen: NDArray[np.int64],
        position: NDArray[np.float64],
        velocity: NDArray[np.float64],
        step: int,
    ) -> NewParticles:
        """Return the particles as arrays; streams add how they fly."""
        del step
        templates = self.settings.distribution
        return NewParticles(
            position=position,
            velocity=velocity,
            omega=np.full((len(position), 3), self.settings.omega),
            radius=templates.radii[chosen],
            density=templates.densities[chosen],
            mass=templates.masses[chosen],
            type=templates.types[chosen],
            template=chosen,
        )

    def radii(self, chosen: NDArray[np.int64]) -> NDArray[np.float64]:
        """Return the radii of the chosen templates, m."""
        found: NDArray[np.float64] = self.settings.distribution.radii[chosen]
        return found

    def rates(self, dt: float) -> None:
        """Compute total and number per event from nparticles or mass and the given rate."""
        s = self.settings
        mean = s.distribution.mean_mass
        if not s.number and not s.unlimited:
            if not s.mass:
                msg = f"{self.style}: give either 'nparticles' or 'mass' (a number or INF)"
                raise InputError(msg)
            if s.mass / mean > 2.0e9:
                msg = f"{self.style}: mass {s.mass:g} kg means more than 2e9 particles"
                raise InputError(msg)
        number = s.number or self.number_of_mass(s.mass, mean)
        self._progress.count_rates(s, number, dt, self.style)

    def number_of_mass(self, mass: float, mean: float) -> int:
        """Return the number of particles of a total mass."""
        return int(mass / mean)

    def by_rate(self) -> int:
        """Return the number of particles of one event of a constant rate."""
        progress = self._progress
        wanted = int(progress.per_event + self.random.uniform())
        if progress.total and progress.inserted + wanted > progress.number:
            wanted = progress.number - progress.inserted
        return wanted

    def state(self) -> dict[str, float]:
        """Return what a restart needs; all numbers are exact as float."""
        progress = self._progress
        return {
            "seed": float(self.random.state[SEED]),
            "saved": float(self.random.state[KEPT_READY]),
            "gauss": float(self.random.state[KEPT_NORMAL]),
            "distribution_seed": float(self.settings.distribution.random.state[SEED]),
            "inserted": float(progress.inserted),
            "inserted_mass": progress.inserted_mass,
            "exact": float(progress.exact),
            "next_step": -1.0 if progress.next_step is None else float(progress.next_step),
        }

    def restore(self, state: dict[str, float]) -> None:
        """Go on from a state; before `setup` it takes effect there.

        Restart files of LIGGGHTS keep less, and what they keep takes effect before `setup`: it
        begins with the generator as if its present state were the seed of the command.
        """
        if "exact" not in state:
            self.settings.seed = int(state["seed"])
            self.random.reset(self.settings.seed)
            self._progress.inserted = int(state["inserted"])
            self._progress.inserted_mass = state["inserted_mass"]
            if state["next_step"] > 0:
                self._set_next_step(state)
            return
        if self._progress.ready:
            self.apply_state(state)
        else:
            self._restored = dict(state)
            self._set_next_step(state)

    def apply_state(self, state: dict[str, float]) -> None:
        """Set generators and counters."""
        self.random.state[:] = (state["seed"], state["saved"], state["gauss"])
        self.settings.distribution.random.reset(int(state["distribution_seed"]))
        self._progress.inserted = int(state["inserted"])
        self._progress.inserted_mass = state["inserted_mass"]
        self._progress.exact = bool(state["exact"])
        self._set_next_step(state)

    def _set_next_step(self, state: dict[str, float]) -> None:
        following = int(state["next_step"])
        self._progress.next_step = None if following < 0 else following
