"""Where numbers of a block of contacts of particles stand, see `minidem.kernels.contact.block`."""

from __future__ import annotations

from minidem.kernels.contact.block import BLOCK, FOUR
from minidem.kernels.models import BASIC

# where the fields of a block begin; the first eight of a particle are its row
(
    X_I, Y_I, Z_I, RADIUS_I, VX_I, VY_I, VZ_I, MASS_I,
    X_J, Y_J, Z_J, RADIUS_J, VX_J, VY_J, VZ_J, MASS_J,
    SPIN_IX, SPIN_IY, SPIN_IZ, _, SPIN_JX, SPIN_JY, SPIN_JZ, _,  # rad/s
    SHIFT_X, SHIFT_Y, SHIFT_Z,  # tangential displacement, m
    SPRING_X, SPRING_Y, SPRING_Z,  # stored torque, N m
    EFFECTIVE,  # mass if one of the two is frozen, else 0, kg
    MATERIAL,  # the coefficients, as many as `BASIC`
) = range(0, 32 * BLOCK, BLOCK)  # fmt: skip
NUMBERS = MATERIAL + BASIC * BLOCK
# the law overwrites what it has read: force on i and on j, N, and torques, N m
(
    PUSH_X, PUSH_Y, PUSH_Z, TWIST_IX, TWIST_IY, TWIST_IZ, TWIST_JY, TWIST_JZ,
    PULL_X, PULL_Y, PULL_Z, TWIST_JX,
) = range(0, 12 * BLOCK, BLOCK)  # fmt: skip
# lines of four per contact that these and the histories are turned into
ON_I, BOTH, ON_J, KEPT, KEPT_LATE = range(0, 20 * FOUR, 4 * FOUR)
LINES = 20 * FOUR
