"""Computes, one module per family of words; importing this package registers them all."""

from minidem.computes import arrangement as arrangement
from minidem.computes import centre as centre
from minidem.computes import contacts as contacts
from minidem.computes import displace as displace
from minidem.computes import energy as energy
from minidem.computes import neighbours as neighbours
from minidem.computes import property_atom as property_atom
from minidem.computes import reduce as reduce
from minidem.computes import slices as slices
from minidem.computes import stress as stress
from minidem.computes import tracers as tracers
