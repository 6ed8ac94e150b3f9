"""What the engine writes: dumps, log, screen; importing this package registers the dump styles."""

from minidem.output import dump_custom as dump_custom
from minidem.output import dump_stl as dump_stl
