"""Commands of a script, one module per family; importing this package registers them all."""

from minidem.commands import atoms as atoms
from minidem.commands import bookkeeping as bookkeeping
from minidem.commands import box as box
from minidem.commands import computes as computes
from minidem.commands import contact as contact
from minidem.commands import creation as creation
from minidem.commands import data_file as data_file
from minidem.commands import displacement as displacement
from minidem.commands import fixes as fixes
from minidem.commands import outputs as outputs
from minidem.commands import particles as particles
from minidem.commands import reports as reports
from minidem.commands import restarts as restarts
from minidem.commands import runs as runs
from minidem.commands import setup as setup
