"""What is inserted: particle templates and their discrete distribution."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from minidem.errors import InputError, UnknownWordError, suggest
from minidem.insertion.seeds import ParkMiller, read_seed
from minidem.record import record
from minidem.words import Words

__all__ = ["Distribution", "Template", "make_distribution", "make_template"]


@record(frozen=True)
class Template:
    """A kind of sphere.

    Attributes
    ----------
    name : str
        Name of the fix.
    seed : int
        Its seed; nothing is drawn while radius and density are constant.
    type : int
        Material type, from 1.
    radius : float
        m.
    density : float
        kg/m3.
    """

    name: str
    seed: int
    type: int
    radius: float
    density: float

    @property
    def volume(self) -> float:
        """Volume in m3, rounded as LIGGGHTS rounds it."""
        r = self.radius
        return r * r * r * 4.0 * math.pi / 3.0

    @property
    def mass(self) -> float:
        """Mass in kg."""
        return self.density * self.volume


def make_template(name: str, words: Sequence[str]) -> Template:
    """Make a template from the words after ``particletemplate/sphere``.

    Parameters
    ----------
    name : str
        Name of the fix.
    words : sequence of str
        ``SEED atom_type 1 density constant 2500 radius constant 0.002``.

    Raises
    ------
    InputError
        For unknown keywords, missing radius or density, or a volume below the limit.
    """
    source = Words(words, "particletemplate/sphere")
    seed = read_seed(source.take("a seed"))
    kind, limit = 1, 1e-12
    values: dict[str, float] = {}
    keywords = ("atom_type", "density", "radius", "volume_limit", "relative")
    while not source.done():
        word = source.choice(keywords)
        if word == "atom_type":
            kind = source.count()
            if kind < 1:
                msg = f"particletemplate/sphere: atom_type must be at least 1, got {kind}"
                raise InputError(msg)
        elif word == "volume_limit":
            limit = source.positive()
        elif word == "relative":
            source.yes_no()
        else:
            _refuse_random(word, source.peek())
            source.choice(("constant",))
            values[word] = source.positive()
    for word in ("density", "radius"):
        if word not in values:
            msg = f"particletemplate/sphere: '{word} constant VALUE' is missing"
            raise InputError(msg)
    template = Template(name, seed, kind, values["radius"], values["density"])
    if template.volume < limit:
        msg = (
            f"particletemplate/sphere: volume {template.volume:g} m3 is below the limit {limit:g};"
            " add 'volume_limit' if that is meant"
        )
        raise InputError(msg)
    return template


def _refuse_random(word: str, style: str) -> None:
    """Refuse the spread sizes and densities that LIGGGHTS had before 3.8.0."""
    if style in ("gaussian", "uniform", "lognormal"):
        msg = (
            f"particletemplate/sphere: {word} '{style}' is a word of other editions, LIGGGHTS "
            f"3.8.0 has none but '{word} constant VALUE' either; write a template for each of some "
            f"values and mix them with fix particledistribution/discrete"
        )
        raise UnknownWordError(msg)


class Distribution:
    """A mixture of templates.

    Parameters
    ----------
    templates : sequence of Template
        The kinds of sphere.
    weights : sequence of float
        Their share of the mass, or of the number if `by_number`; any positive scale.
    seed : int
        Seed of the generator that deals out what cannot be divided evenly.
    by_number : bool
        Meaning of `weights`.

    Attributes
    ----------
    mean_mass, mean_volume : float
        Expected mass (kg) and volume (m3) of a particle.
    max_radius : float
        m.
    radii, densities, masses, types : ndarray
        Of the templates, m, kg/m3, kg.
    total : float
        Sum of the weights as they were given.
    """

    def __init__(
        self, templates: Sequence[Template], weights: Sequence[float], seed: int, by_number: bool
    ) -> None:
        self.templates = tuple(templates)
        self.seed = seed
        self.random = ParkMiller(seed)
        self.total = float(sum(weights))
        share = _normalised(list(weights))
        if not by_number:
            share = _normalised(
                [w / template.mass for w, template in zip(share, templates, strict=True)]
            )
        self.share = share
        self.mean_volume = self.mean_mass = 0.0
        for template, part in zip(templates, share, strict=True):
            self.mean_volume += template.volume * part
            self.mean_mass += template.mass * part
        self.max_radius = max(template.radius for template in templates)
        self.radii = np.array([t.radius for t in templates])
        self.densities = np.array([t.density for t in templates])
        self.masses = np.array([t.mass for t in templates])
        self.types = np.array([t.type for t in templates], np.int64)
        # Large particles first: they find a place before the small ones take it.
        self._order = np.array(
            sorted(range(len(share)), key=lambda i: -templates[i].volume), np.int64
        )

    def deal(self, count: int, *, exact: bool) -> NDArray[np.int64]:
        """Choose the templates of `count` particles.

        Parameters
        ----------
        count : int
            Particles asked for.
        exact : bool
            Whether exactly `count` must result; else the number fluctuates so that the long-term
            mean is right.

        Returns
        -------
        (n,) ndarray of int
            Index of the template of each particle, large particles first.
        """
        if exact:
            numbers = self._deal_exactly(count)
        else:
            numbers = [int(float(count) * part + self.random.uniform()) for part in self.share]
        return self._order.repeat([numbers[i] for i in self._order.tolist()])

    def _deal_exactly(self, count: int) -> list[int]:
        numbers = [int(float(count) * part) for part in self.share]
        rest = [float(count) * part - float(n) for part, n in zip(self.share, numbers, strict=True)]
        gap = count - sum(numbers)
        for _ in range(gap):
            target = self.random.uniform() * float(gap)
            j, total = 0, rest[0]
            while total < target and j < len(rest) - 1:
                j += 1
                total += rest[j]
            numbers[j] += 1
        return numbers


def _normalised(values: list[float]) -> list[float]:
    total = 0.0
    for value in values:
        total += value
    return [value / total for value in values]


def make_distribution(
    style: str, words: Sequence[str], templates: Mapping[str, Template]
) -> Distribution:
    """Make a distribution from the words after its style.

    Parameters
    ----------
    style : str
        ``particledistribution/discrete`` (weights are shares of the mass), or with
        ``/massbased`` or ``/numberbased``.
    words : sequence of str
        ``SEED N TEMPLATE WEIGHT ...``.
    templates : mapping
        Templates defined so far.

    Raises
    ------
    InputError
        With what was expected.
    """
    source = Words(words, style)
    seed = read_seed(source.take("a seed"))
    count = source.count()
    chosen: list[Template] = []
    weights: list[float] = []
    while not source.done():
        name = source.take("a template")
        if name not in templates:
            msg = f"{style}: unknown template '{name[:40]}'{suggest(name[:80], templates)}"
            raise InputError(msg)
        chosen.append(templates[name])
        weights.append(source.number())
    if len(chosen) != count or count < 1:
        msg = f"{style}: {count} templates announced, {len(chosen)} given"
        raise InputError(msg)
    if min(weights) < 0.0 or sum(weights) <= 0.0:
        msg = f"{style}: weights must not be negative and not all zero"
        raise InputError(msg)
    if len({template.name for template in chosen}) < count:
        msg = f"{style}: a template may be named only once"
        raise InputError(msg)
    return Distribution(chosen, weights, seed, by_number=style.endswith("numberbased"))
