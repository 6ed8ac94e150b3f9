"""Particle templates, distributions and insertion."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from minidem.fixes.insert import DistributionFix, Insert, TemplateFix
from minidem.insertion import (
    DISTRIBUTION_STYLES,
    STYLES,
    Surroundings,
    make_distribution,
    make_inserter,
    make_template,
)
from minidem.registry import fix
from minidem.run.engine import Engine
from minidem.world.state import Bools, Floats


@fix("particletemplate/sphere")
def _template(engine: Engine, name: str, style: str, group: str, words: Sequence[str]) -> object:
    bit = (
        engine.world.group_bit(group)
        if group not in engine.world.groups
        else engine.world.bit(group)
    )
    return TemplateFix(name, style, bit, make_template(name, words))


@fix(*DISTRIBUTION_STYLES)
def _distribution(
    engine: Engine, name: str, style: str, group: str, words: Sequence[str]
) -> object:
    found = engine.world.of_kind(TemplateFix)
    templates = {fix.name: fix.template for fix in found}
    made = make_distribution(style, words, templates)
    used = {template.name for template in made.templates}
    bits = {fix.name: fix.bit for fix in found if fix.name in used}
    member = tuple(bits.get(template.name, 1) for template in made.templates)
    return DistributionFix(name, style, engine.world.bit(group), made, member)


@fix(*STYLES)
def _insert(engine: Engine, name: str, style: str, group: str, words: Sequence[str]) -> object:
    world = engine.world
    found = world.of_kind(DistributionFix)

    def face(mesh: str) -> Floats:
        lo, hi = world.meshes.span(mesh) if mesh in world.meshes.names else (0, 0)
        if lo == hi:
            raise KeyError(mesh)
        nodes: Floats = world.meshes.table.node[lo:hi].copy()
        return nodes

    def rim(mesh: str) -> Bools | None:
        if world.fixes[mesh].style != "mesh/surface/planar":
            return None
        lo, hi = world.meshes.span(mesh)
        flags = world.meshes.table.flags[lo:hi, None]
        edges: Bools = (flags & np.array([1, 2, 4])) != 0
        return edges

    around = Surroundings(
        {fix.name: fix.distribution for fix in found}, world.regions, face, world.step, world.dt,
        rim,
    )  # fmt: skip
    inserter = make_inserter(name, style, words, around)
    words = list(words)
    chosen = (
        words[words.index("distributiontemplate") + 1] if "distributiontemplate" in words else ""
    )
    distribution = next((fix for fix in found if fix.name == chosen), None)
    return Insert(name, style, world.bit(group), inserter, distribution)
