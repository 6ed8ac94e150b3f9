"""Regions of space as scripts define them."""

from minidem.insertion.region.making import STYLES as STYLES
from minidem.insertion.region.making import Site as Site
from minidem.insertion.region.making import make_region as make_region
from minidem.insertion.region.region import Region as Region

__all__ = ["STYLES", "Region", "Site", "make_region"]
