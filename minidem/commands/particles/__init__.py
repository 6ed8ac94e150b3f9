"""Commands that copy, delete, move and read particles; importing registers them."""

from minidem.commands.particles import deletion as deletion
from minidem.commands.particles import from_dump as from_dump
from minidem.commands.particles import replication as replication
from minidem.commands.particles import velocity as velocity
