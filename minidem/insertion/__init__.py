"""Insertion of particles, with the random numbers of LIGGGHTS."""

from minidem.insertion.distribution import DISTRIBUTION_STYLES as DISTRIBUTION_STYLES
from minidem.insertion.distribution import Distribution as Distribution
from minidem.insertion.distribution import Template as Template
from minidem.insertion.distribution import make_distribution as make_distribution
from minidem.insertion.distribution import make_template as make_template
from minidem.insertion.factory import STYLES as STYLES
from minidem.insertion.factory import Surroundings as Surroundings
from minidem.insertion.factory import make_inserter as make_inserter
from minidem.insertion.inserter import Inserter as Inserter
from minidem.insertion.particles import Flight as Flight
from minidem.insertion.particles import NewParticles as NewParticles
from minidem.insertion.particles import Present as Present
from minidem.insertion.region import Region as Region
from minidem.insertion.region import Site as Site
from minidem.insertion.region import make_region as make_region
from minidem.insertion.settings import Domain as Domain
from minidem.insertion.stream import Stream as Stream

__all__ = [
    "DISTRIBUTION_STYLES",
    "STYLES",
    "Distribution",
    "Domain",
    "Flight",
    "Inserter",
    "NewParticles",
    "Present",
    "Region",
    "Site",
    "Stream",
    "Surroundings",
    "Template",
    "make_distribution",
    "make_inserter",
    "make_region",
    "make_template",
]
