"""Commands that copy and delete particles and give them velocities; importing registers them."""

from minidem.commands.particles import deletion as deletion
from minidem.commands.particles import replication as replication
from minidem.commands.particles import velocity as velocity
