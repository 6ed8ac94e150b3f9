"""Fixes that put particles, or the box, somewhere in every step; importing registers them."""

from minidem.fixes.carried import deform as deform
from minidem.fixes.carried import move as move
