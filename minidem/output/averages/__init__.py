"""Fixes that keep values for output: means over time, and values per particle."""

from minidem.output.averages import atom as atom
from minidem.output.averages import correlation as correlation
from minidem.output.averages import dump_euler as dump_euler
from minidem.output.averages import euler as euler
from minidem.output.averages import histogram as histogram
from minidem.output.averages import spatial as spatial
from minidem.output.averages import stored as stored
from minidem.output.averages import time as time
from minidem.output.averages import tracers as tracers
