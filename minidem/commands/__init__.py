"""Commands of a script, one module per family; importing this package registers them all."""

from minidem.commands import atoms as atoms
from minidem.commands import computes as computes
from minidem.commands import inserts as inserts
from minidem.commands import outputs as outputs
from minidem.commands import physics as physics
from minidem.commands import reports as reports
from minidem.commands import restarts as restarts
from minidem.commands import runs as runs
from minidem.commands import setup as setup
from minidem.commands import walls as walls
from minidem.registry import COMMANDS as COMMANDS
from minidem.registry import FIXES as FIXES

__all__ = ["COMMANDS", "FIXES"]
