"""Keywords that all insertion commands share."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from minidem.errors import InputError, suggest
from minidem.insertion.distribution import Distribution
from minidem.insertion.seeds import read_seed
from minidem.record import field, record
from minidem.words import Words

__all__ = ["Domain", "Settings", "read_settings"]


@record(frozen=True)
class Domain:
    """The simulation box at the moment of insertion.

    Attributes
    ----------
    box : (2, 3) ndarray
        Lower and upper corner, m.
    boundary : tuple of str
        Three letters p, f, s or m.
    """

    box: NDArray[np.float64]
    boundary: tuple[str, str, str]

    @property
    def changes(self) -> bool:
        """Whether the box follows the particles."""
        return any(letter in "sm" for face in self.boundary for letter in face)


@record
class Settings:
    """Values of the common keywords.

    Attributes
    ----------
    seed : int
        Seed of the command's generator.
    distribution : Distribution
        What is inserted.
    attempts : int
        Points tried per particle.
    number, mass : float or None
        Total to insert; None if not given or INF.
    unlimited : bool
        Whether INF was given.
    mass_rate, particle_rate : float
        kg/s and 1/s, 0 if not given.
    every : int
        Steps between insertions; 0 for once, -1 if not given.
    start : int
        First step.
    check_overlap, all_in, verbose, exact : bool
        See the manual page of fix insert.
    velocity_style : int
        0 constant, 1 uniform, 2 gaussian.
    velocity : (2, 3) ndarray
        Mean and fluctuation, m/s.
    omega : (3,) ndarray
        rad/s.
    turned : bool
        Whether orientations are random.
    given : tuple of str and float, or None
        A ``property/atom`` and its value for particles that are inserted.
    compressed : bool
        Whether all particles get the ids 1, 2, 3 and so on after every insertion.
    """

    seed: int
    distribution: Distribution
    start: int
    attempts: int = 50
    number: int = 0
    mass: float = 0.0
    unlimited: bool = False
    mass_rate: float = 0.0
    particle_rate: float = 0.0
    every: int = -1
    check_overlap: bool = True
    all_in: bool = False
    verbose: bool = True
    exact: bool = True
    velocity_style: int = 0
    velocity: NDArray[np.float64] = field(default_factory=lambda: np.zeros((2, 3)))
    omega: NDArray[np.float64] = field(default_factory=lambda: np.zeros(3))
    turned: bool = False
    given: tuple[str, float] | None = None
    compressed: bool = False


_KEYWORDS = (
    "distributiontemplate",
    "maxattempt",
    "nparticles",
    "mass",
    "massrate",
    "particlerate",
    "insert_every",
    "insert_every_time",
    "every",
    "start",
    "overlapcheck",
    "all_in",
    "random_distribute",
    "verbose",
    "vel",
    "omega",
    "orientation",
    "compress_tags",
    "set_property",
)


def read_settings(
    source: Words, style: str, distributions: Mapping[str, Distribution], step: int, dt: float
) -> Settings:
    """Read the common keywords; stops at the first word that is none of them.

    Parameters
    ----------
    source : Words
        Cursor at the word after the style.
    style : str
        Style for messages.
    distributions : mapping
        Distributions defined so far.
    step : int
        Present step.
    dt : float
        Time step, s.

    Raises
    ------
    InputError
        With the word and what was expected.
    """
    if source.take("keyword 'seed'") != "seed":
        msg = f"{style}: the first keyword must be 'seed'"
        raise InputError(msg)
    values = _Reader(Settings(read_seed(source.take("a seed")), _NOTHING, step + 1), source, style)
    while source.peek() in _KEYWORDS:
        values.read(distributions, step, dt)
    settings = values.settings
    if settings.distribution is _NOTHING:
        msg = f"{style}: keyword 'distributiontemplate' is missing"
        raise InputError(msg)
    _check(settings, style)
    return settings


_NOTHING: Distribution = object.__new__(Distribution)


class _Reader:
    """Reads one keyword after the other into settings."""

    def __init__(self, settings: Settings, source: Words, style: str) -> None:
        self.settings = settings
        self.source = source
        self.style = style

    def read(self, distributions: Mapping[str, Distribution], step: int, dt: float) -> None:
        s, source = self.settings, self.source
        word = source.take("a keyword")
        if word == "distributiontemplate":
            self._distribution(distributions)
        elif word == "maxattempt":
            s.attempts = source.count(least=1)
        elif word == "massrate":
            s.mass_rate = source.positive()
        elif word == "particlerate":
            s.particle_rate = source.positive()
        elif word in ("nparticles", "mass"):
            self._total(word)
        elif word in ("insert_every", "insert_every_time", "every", "start"):
            self._time(word, step, dt)
        elif word in ("vel", "omega", "orientation"):
            self._motion(word)
        elif word in ("compress_tags", "set_property"):
            self._mark(word)
        elif word == "random_distribute":
            s.exact = source.choice(("exact", "uncorrelated")) == "exact"
        else:
            name = {"overlapcheck": "check_overlap"}.get(word, word)
            setattr(s, name, source.yes_no())

    def _distribution(self, distributions: Mapping[str, Distribution]) -> None:
        name = self.source.take("the name of a particle distribution")
        if name not in distributions:
            hint = suggest(name[:80], distributions)
            msg = f"{self.style}: unknown particle distribution '{name[:40]}'{hint}"
            raise InputError(msg)
        self.settings.distribution = distributions[name]

    def _total(self, word: str) -> None:
        if self.source.peek() == "INF":
            self.source.take("INF")
            self.settings.unlimited = True
        elif word == "nparticles":
            self.settings.number = int(self.source.positive())
        else:
            self.settings.mass = self.source.positive()

    def _time(self, word: str, step: int, dt: float) -> None:
        s, source = self.settings, self.source
        if word == "start":
            s.start = source.count()
            if s.start < step + 1:
                msg = f"{self.style}: start {s.start} is not after the present step {step}"
                raise InputError(msg)
        elif source.peek() == "once":
            source.take("once")
            s.every = 0
        else:
            s.every = int(source.number() / dt) if word.endswith("_time") else source.count()
            if s.every < 0:
                msg = f"{self.style}: insert_every must not be negative, got {s.every}"
                raise InputError(msg)

    def _mark(self, word: str) -> None:
        """Read a property of new particles, or whether ids are made 1, 2, 3 and so on."""
        if word == "set_property":
            self.settings.given = self.source.take("a property"), self.source.number()
        else:
            self.settings.compressed = self.source.yes_no()

    def _motion(self, word: str) -> None:
        s, source = self.settings, self.source
        if word == "vel":
            styles = ("constant", "uniform", "gaussian")
            s.velocity_style = styles.index(source.choice(styles))
            for row in range(1 if s.velocity_style == 0 else 2):
                s.velocity[row] = [source.number() for _ in range(3)]
        elif word == "omega":
            source.choice(("constant",))
            s.omega[:] = [source.number() for _ in range(3)]
        else:
            self._orientation()

    def _orientation(self) -> None:
        """Read an orientation, of which spheres show nothing; a random one draws numbers."""
        style = self.source.choice(("random", "template", "constant"))
        if style != "constant":  # which leaves a `random` before it, as in LIGGGHTS
            self.settings.turned = style == "random"
        for _ in range(4 if style == "constant" else 0):
            self.source.number()


def _seeds(s: Settings) -> list[int]:
    """Return the seeds of an insertion, of its distribution and of its templates."""
    return [s.seed, s.distribution.seed, *(one.seed for one in s.distribution.templates)]


def _check(s: Settings, style: str) -> None:
    """Refuse settings that contradict each other."""
    if s.number and s.mass:
        msg = f"{style}: give either 'nparticles' or 'mass', not both"
    elif s.particle_rate and s.mass_rate:
        msg = f"{style}: give either 'particlerate' or 'massrate', not both"
    elif s.every == 0 and (s.particle_rate or s.mass_rate):
        msg = f"{style}: 'insert_every once' goes with no rate"
    elif len(seeds := _seeds(s)) > len(set(seeds)):
        msg = (
            f"{style}: seeds of insertion, distribution and templates must differ, found "
            f"{', '.join(map(str, seeds))}; use different primes"
        )
    else:
        return
    raise InputError(msg)
