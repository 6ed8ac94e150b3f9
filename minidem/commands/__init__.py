"""Commands of a script, one module per family; importing this package registers them all.

Families that most scripts do without are loaded when one of their commands is looked up.
"""

from minidem.commands import atoms as atoms
from minidem.commands import bookkeeping as bookkeeping
from minidem.commands import box as box
from minidem.commands import contact as contact
from minidem.commands import fixes as fixes
from minidem.commands import outputs as outputs
from minidem.commands import runs as runs
from minidem.commands import setup as setup
from minidem.commands.command import COMMANDS

COMMANDS.later("minidem.commands.computes", "compute", "uncompute", "compute_modify")
COMMANDS.later("minidem.commands.creation", "lattice", "create_atoms")
COMMANDS.later("minidem.commands.data_file", "read_data")
COMMANDS.later("minidem.commands.displacement", "displace_atoms")
COMMANDS.later("minidem.commands.particles.deletion", "delete_atoms")
COMMANDS.later("minidem.commands.particles.from_dump", "read_dump")
COMMANDS.later("minidem.commands.particles.replication", "replicate")
COMMANDS.later("minidem.commands.particles.velocity", "velocity")
COMMANDS.later("minidem.commands.reports", "echo", "info", "log", "thermo_log")
COMMANDS.later("minidem.commands.restarts", "write_restart", "read_restart", "restart")
