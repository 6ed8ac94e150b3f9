"""Values of the model switches, 0 is off, and the columns of the coefficients of contact models.

Numba takes the names as constants. Units as in `minidem.kernels.columns`, which has the switches.
"""

from __future__ import annotations

# -- coefficients, a row per ordered pair of types
YOUNG = 0  # effective Young's modulus, Pa
SHEAR = 1  # effective shear modulus, Pa
DAMPING = 2  # -2 sqrt(5/6) B with B = ln e / sqrt(ln(e)^2 + pi^2)
FRICTION = 4
ROLLING_FRICTION = 5
COHESION_ENERGY = 6  # density, J/m3
ROLLING_DAMPING = 7  # viscous ratio (epsd)
LOG_RESTITUTION = 8
CHARACTERISTIC_SPEED = 9  # of hooke, m/s
BASIC = 10  # the columns up to here serve the models that have loops of their own
STATIC_FRICTION = 10
WEAKENING_SPEED = 11  # sliding speed over which static becomes kinetic friction, m/s
RESTITUTION_EXPONENT = 12  # of the impact speed
RESTITUTION_SPEED = 13  # impact speed above which restitution falls, m/s
RESTITUTION_DEVIATION = 14  # standard deviation over contacts, as a part of the restitution
TANGENTIAL_FACTOR = 15  # of Mindlin's tangential stiffness
FINNIE = 16  # wear coefficient, 1/Pa; the second type is that of the mesh
NORMAL_STIFFNESS, TANGENTIAL_STIFFNESS = 17, 18  # of hooke/stiffness, N/m; hertz/stiffness, Pa
NORMAL_RATE, TANGENTIAL_RATE = 19, 20  # damping per mass: 1/s; hertz/stiffness 1/(m s)
NORMAL_DASHPOT, TANGENTIAL_DASHPOT = 21, 22  # absolute damping, kg/s
FLUID_VISCOSITY = 23  # of viscous hooke, Pa s; of tan_luding dynamic over static friction
CRITICAL_STOKES, MAXIMUM_RESTITUTION = 24, 25
ROLLING_STIFFNESS = 26  # factor of epsd3
LOADING = 27  # stiffness, N/m
UNLOADING, ADHESIVE = 28, 29  # stiffness of unloading and of adhesion over that of loading
LARGEST_UNLOADING = 30  # of hooke/hysteresis, over the stiffness of loading
PLASTICITY_DEPTH = 31  # of overlap over diameter, at which it is reached
PULL_OFF = 32  # force, N
SURFACE_ENERGY = 33  # J/m2
ADHESION_EXPONENT, OVERLAP_EXPONENT = 34, 35
SLIDING_VISCOSITY, SLIDING_STIFFNESS = 36, 37  # over those of the normal model, tan_luding
TURNING_STIFFNESS = 38  # rolling over tangential stiffness, luding
YIELD_RATIO = 39  # of thornton_ning: contact radius at yield over the radius of the first type
# of liquid bridges: N/m; Pa s; rad; least gap in viscous forces over effective radius
SURFACE_TENSION, BRIDGE_VISCOSITY, CONTACT_ANGLE, LEAST_GAP = 40, 41, 42, 43
LARGEST_GAP = 44  # over the sum of the radii, at which a bridge breaks in any case
LIQUID_LIMIT = 45  # content of the first type
BRIDGE_SHARE = 46  # of the liquid of both
COEFFICIENTS = 47  # columns

# -- model switches: values of the normal model; those up to HOOKE have loops of their own, those
# from HOOKE_HYSTERESIS on keep how far they were loaded, those from LUDING on attract
HERTZ, HOOKE, HOOKE_STIFFNESS, HERTZ_STIFFNESS, HOOKE_HYSTERESIS = range(5)
LUDING, EDINBURGH, EDINBURGH_STIFFNESS, THORNTON_NING = 5, 6, 7, 8
# of the tangential model
HISTORY, NO_HISTORY, TAN_LUDING = 1, 2, 3
# of the rolling model; those up to EPSD2 have loops of their own, those from EPSD on keep a torque
CDT, EPSD, EPSD2, EPSD3, ROLL_LUDING = 1, 2, 3, 4, 5
# of the cohesion model; those from EASO on are liquid bridges
SJKR, SJKR2, EASO, WASHINO = 1, 2, 3, 4
