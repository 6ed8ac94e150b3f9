"""Computes, one module per family of words, each with a line here.

A module is imported when a script uses one of its words.
"""

from minidem.world.compute import COMPUTES

COMPUTES.later("minidem.computes.arrangement", "rdf", "cluster/atom", "msd")
COMPUTES.later("minidem.computes.centre", "com", "gyration")
COMPUTES.later("minidem.computes.contacts", "pair/gran/local", "wall/gran/local")
COMPUTES.later("minidem.computes.crystal", "centro/atom")
COMPUTES.later("minidem.computes.displace", "displace/atom")
COMPUTES.later(
    "minidem.computes.energy", "erotate", "erotate/sphere", "ke", "ke/atom", "erotate/sphere/atom",
    "pe", "pe/atom",
)  # fmt: skip
COMPUTES.later("minidem.computes.neighbours", "contact/atom", "contact/atom/gran", "coord/atom")
COMPUTES.later("minidem.computes.property_atom", "property/atom")
COMPUTES.later("minidem.computes.reduce", "reduce", "reduce/region")
COMPUTES.later("minidem.computes.slices", "slice")
COMPUTES.later("minidem.computes.stress", "stress/atom", "pressure")
COMPUTES.later("minidem.computes.temperature", "temp")
COMPUTES.later("minidem.computes.tracers", "nparticles/tracer/region")
