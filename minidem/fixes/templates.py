"""Particle templates and their mixtures, what the insertion fixes draw from.

``fix ID all particletemplate/sphere SEED atom_type 1 density constant 2500 radius constant 0.002``
and ``fix ID all particledistribution/discrete SEED N TEMPLATE WEIGHT ...``.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from minidem.insertion import DISTRIBUTION_STYLES
from minidem.insertion.distribution import Distribution, Template, make_distribution, make_template
from minidem.record import record
from minidem.registry import Head
from minidem.words import Words
from minidem.world.fix import FIXES, Fix
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["DistributionFix", "TemplateFix", "largest_radii"]

_ROUNDING = 1e-5  # of a sum of weights, as in LIGGGHTS


@FIXES.register("particletemplate/sphere")
@record
class TemplateFix(Fix):
    """A kind of sphere.

    Attributes
    ----------
    template : Template
        Type, radius and density.
    """

    template: Template

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> TemplateFix:
        """Read seed, type, density and radius."""
        del world
        return cls(*head, make_template(head.name, words.rest()))


@FIXES.register(*DISTRIBUTION_STYLES)
@record
class DistributionFix(Fix):
    """A mixture of templates.

    Attributes
    ----------
    distribution : Distribution
        Templates and their shares.
    member_bits : tuple of int
        Group bit of each of its templates.
    """

    distribution: Distribution
    member_bits: tuple[int, ...] = ()

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> DistributionFix:
        """Read seed, templates and weights."""
        known = {fix.name: fix for fix in world.of_kind(TemplateFix)}
        templates = {name: fix.template for name, fix in known.items()}
        made = make_distribution(head.style, words.rest(), templates)
        if abs(made.total - 1.0) > _ROUNDING:
            world.warn(
                f"fix {head.name}: the weights sum up to {made.total:g}, not 1; they are "
                "normalized, as LIGGGHTS does"
            )
        bits = tuple(known[template.name].bit for template in made.templates)
        return cls(*head, made, bits)

    def material_types(self) -> tuple[int, ...]:
        """Return the types of its templates."""
        return tuple(template.type for template in self.distribution.templates)

    def restore(self, saved: Mapping[str, Any]) -> None:
        """Take the generator from a restart file of LIGGGHTS; minidem's keep it with insertion."""
        self.distribution.random.reset(int(saved["seed"]))


def largest_radii(world: World) -> Floats:
    """Return the largest radius of each type in all distributions, 0 without one, (types,), m."""
    found = np.zeros(world.types)
    for fix in world.of_kind(DistributionFix):
        for template in fix.distribution.templates:
            kind = template.type - 1
            found[kind] = max(found[kind], template.radius)
    return found
