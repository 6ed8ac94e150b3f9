"""Fixes that add or set forces after contacts, one module per word; importing registers them."""

from minidem.fixes.forces import addforce as addforce
from minidem.fixes.forces import aveforce as aveforce
from minidem.fixes.forces import buoyancy as buoyancy
from minidem.fixes.forces import drag as drag
from minidem.fixes.forces import drag_sphere as drag_sphere
from minidem.fixes.forces import freeze as freeze
from minidem.fixes.forces import gravity as gravity
from minidem.fixes.forces import lines as lines
from minidem.fixes.forces import momentum as momentum
from minidem.fixes.forces import sieve as sieve
from minidem.fixes.forces import springs as springs
from minidem.fixes.forces import store_force as store_force
from minidem.fixes.forces import viscous as viscous
from minidem.fixes.forces import wall_region as wall_region
