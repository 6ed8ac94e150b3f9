"""Fixes that count particles through meshes, and what the kernels need for it."""

from minidem.world.fix import FIXES

FIXES.later("minidem.fixes.flow.massflow", "massflow/mesh")
