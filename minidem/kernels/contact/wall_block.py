"""Where numbers of a block of contacts with walls stand, see `minidem.kernels.contact.block`."""

from __future__ import annotations

from minidem.kernels.columns import RADIUS
from minidem.kernels.contact.block import BLOCK, FOUR
from minidem.kernels.models import BASIC

# where the fields of a block begin; the second eight are the row of the particle
(
    LEVER_X, LEVER_Y, LEVER_Z,  # from the wall to the centre, m
    DISTANCE,  # m
    SPEED_X, SPEED_Y, SPEED_Z, _,  # of the wall, m/s
    _, _, _, RADIUS_I, VX_I, VY_I, VZ_I, MASS_I,
    SPIN_IX, SPIN_IY, SPIN_IZ, _,  # rad/s
    SHIFT_X, SHIFT_Y, SHIFT_Z,  # tangential displacement, m
    SPRING_X, SPRING_Y, SPRING_Z,  # stored torque, N m
    MATERIAL,  # the coefficients, as many as `BASIC`
) = range(0, 27 * BLOCK, BLOCK)  # fmt: skip
PLACE_I = RADIUS_I - RADIUS * BLOCK  # the first of the row
NUMBERS = MATERIAL + BASIC * BLOCK
# the law overwrites what it has read: force, N, and torque, N m
PUSH_X, PUSH_Y, PUSH_Z, TWIST_X, TWIST_Y, TWIST_Z = (VX_I + k * BLOCK for k in range(6))
# lines of four per contact that these and the histories are turned into
PUSHED, TWISTED, KEPT, KEPT_LATE = range(0, 16 * FOUR, 4 * FOUR)
LINES = 16 * FOUR
