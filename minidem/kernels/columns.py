"""The columns of the packed tables that kernels work on, by name.

A table of `minidem.kernels.tables` packs several quantities into its rows. Its columns are named
here and nowhere else; Numba takes the names as constants, so that they cost nothing.

- A name that stands for one column ends a subscript: ``row[i, MASS]``.
- A name in the singular over three columns is the first of them; `X`, `Y`, `Z` or a loop index
  choose the component: ``cells[CELL_SIZE + Y]``, ``flight[i, FLIGHT_FROM + c]``.
- Tables whose rows are plain vectors (``held``, ``normal``, ``shift``, ...) take `X`, `Y`, `Z`.

Lengths in m, velocities in m/s, spins in rad/s, forces in N, torques in N m, masses in kg, times
in s. `minidem.kernels.control` and `models` have the values that some of these columns take, and
`minidem.kernels.models` the columns of the coefficients of contact models.

Python takes several columns at once by a slice, which stands under the columns that it covers;
kernels go over them one by one. A comment ``columns`` marks the width of a table.
"""

from __future__ import annotations

X, Y, Z = range(3)  # components of a vector; in Particles.row the position, m

ONLY = 0  # of an array that holds one number, as Flows.count and Motions.base

# -- Particles.row: position, then
RADIUS = 3  # m
VX, VY, VZ = 4, 5, 6  # velocity, m/s
MASS = 7  # kg
ROW = 8  # columns
POSITION, VELOCITY = slice(X, Z + 1), slice(VX, VZ + 1)

# -- Particles.spin; the last column is empty, for rows of a power of two
WX, WY, WZ = range(3)  # rad/s
SPIN = 4  # columns
OMEGA = slice(WX, WZ + 1)

# -- Particles.liquid: on the surface of a grain, volumes over that of the grain
LIQUID_CONTENT = 0  # what is there
LIQUID_FLUX, LIQUID_SOURCE = 1, 2  # what comes from broken bridges, and from elsewhere, 1/s
LIQUID = 3  # columns

# -- Particles.force and Team.spill
FX, FY, FZ = 0, 1, 2  # force, N
TX, TY, TZ = 3, 4, 5  # torque, N m
HALF_KICK = 6  # dt / (2 m), s/kg
HALF_TURN = 7  # dt / (2 I), s/(kg m2)
FORCE = 8  # columns
TOTAL_FORCE, TOTAL_TORQUE, LOAD = slice(FX, FZ + 1), slice(TX, TZ + 1), slice(FX, TZ + 1)
HEAD, REACHED = 0, 6  # Team.spill's first row is nobody's; column: one past the last row in use
SPILT = 7  # Team.spill: liquid flux, 1/s

# -- Walls.load, Team.load: as Particles.force, of the particles on a mesh about its origin
WEAR_NOW, WORN = 3, 6  # of a triangle depth of wear times area, m3: this step's, and of all steps
PARTICLE, TOUCHED = 0, 1  # of contacts asked for one by one: rows of particle, other or triangle

# -- Particles.flight: a particle of an insertion stream on its way
FLIGHT_FROM = 0  # 3: where it starts, m
FLIGHT_START = 3  # step at which it starts
FLIGHT_STOP = 4  # step at which it is released, below zero: it does not fly
FLIGHT_VELOCITY = 5  # 3: until then, m/s
FLIGHT_FINAL = 8  # 3: velocity from then on, m/s
FLIGHT_SPIN = 11  # 3: spin from then on, rad/s
FLIGHT = 16  # columns
FLIGHT_STEPS = slice(FLIGHT_START, FLIGHT_STOP + 1)

# -- Pairs.hist and Walls.hist
SX, SY, SZ = range(3)  # tangential displacement, m
MX, MY, MZ = 3, 4, 5  # spring torque of rolling, N m
IMPACT = 6  # impact speed, m/s; from here on numbers that do not turn with the owner of a pair
LARGEST = 7  # overlap up to which a plastic contact was loaded, m; also this and the next two
LATEST = 8  # overlap of the step before, m
ADHESION = 9  # stiffness of its adhesion, N/m, or N/m^x with an exponent x
FORCE_BEFORE, FORCE_MOST = 10, 11  # of thornton_ning: force of the step before; largest one, N
STAGE = 12  # of thornton_ning: bits, see `minidem.kernels.contact.laws.thornton_ning`
PARTED_AT, PARTED_FORCE = 9, 13  # of thornton_ning: overlap, m, and force, N, of its last parting
REMEMBERED = 14  # columns of all, and of a model:
SLIDING_ONLY, WITH_ROLLING, WITH_IMPACT, WITH_PLASTICITY, WITH_YIELD = 3, 6, 7, 10, 14

# -- More.whole and More.scratch, while rows are put in a new order
KEPT_KIND, KEPT_MASK, KEPT_ID, KEPT_RANK = range(4)
KEPT_MARKER = 0
KEPT_DENSITY = 0
KEPT = 4  # columns of More.whole; More.scratch has those of the widest table
GONE = 2**62  # More.rank of a particle that has left, until lists are made anew

# -- More.cells
CELL_CORNER = 0  # 3: lower corner of the first cell, m
CELL_SIZE = 3  # 3: edges of a cell, m
CELL_COUNT = 6  # 3: number of cells
CELL_LARGEST = 9  # largest radius of a particle, m
CELLS = 12  # columns

# -- More.box
BOX_LOWER, BOX_UPPER = 0, 3  # 3 each: corners, m
BOX_PERIODIC = 6  # 3: 1 in a periodic direction
BOX_MOVES = 9  # 1 if faces move, which is Python's business
BOX = 12  # columns

# -- the period, from the box
PERIOD_FROM, PERIOD = 0, 3  # 3 each: lower corner, length of periodic directions, m; else 0
PERIODS = 6  # columns

# -- More.ranges, a row per flow mesh
RANGE_FIRST, RANGE_END, RANGE_MOVES = 0, 1, 2  # triangles; 1 if the mesh moves
RANGE = 3  # columns

# -- More.needs: room that the lists need, and the particles that stayed
NEED_PAIRS, NEED_WALLS, NEED_FLOWS, NEED_CELLS, NEED_COUNT = range(5)
NEEDS = 8  # columns

# -- Walls.prim, a row per primitive wall
WALL_SHAPE = 0  # PLANE, or else a cylinder
WALL_AXIS = 1  # its normal, or the axis of the cylinder: X, Y or Z
WALL_TYPE = 2  # atom type counted from 0
WALL_GROUP = 3  # bit of the group that it acts on
WALL_TURNS = 4  # 1 if it turns about its axis
WALL_MODEL = 5  # the first of the model switches
WALL_USUAL = 24  # 1 if the model is the one that the loop is compiled for
WALL = 25  # columns
WALL_SWITCHES = slice(WALL_MODEL, WALL_USUAL)
PLANE = 0

# -- Walls.mesh, a row per mesh: WALL_TYPE, WALL_MODEL, WALL_USUAL as above, and
MESH_GROUP = 0  # bit of the group that it acts on, 0 if no wall uses it
MESH_FACETS = 1  # 1 if Walls.load has a row per triangle of it, behind those of the meshes;
MESH_ROW = 3  # there it is that of triangle 0, if that were one of this mesh
MESH_MOVES = 4  # 1 if its surface has a velocity

# -- Walls.value, a row per primitive wall
WALL_PLACE = 0  # of a plane along its normal, or radius, m
WALL_CENTRE = 1  # 2: of a cylinder along the two axes that follow its own in turn, m
WALL_CENTRE_NEXT = 2
WALL_VELOCITY = 3  # 3: m/s
WALL_SPIN = 6  # rad/s
WALL_VALUE = 8  # columns

# -- Walls.touch: bits
EARLIER = 1  # in contact since before
HANDLED = 2  # worked on in this step
PLACE_BIT = 2  # from here on: place among the contacts of a particle and a mesh, from 0
PLACES = 64

# -- Mesh: nodes and edges of a triangle
A, B, C = range(3)  # nodes; the corners
AB, BC, CA = range(3)  # edges, each named after its first node and the next
# Mesh.flags: places of the bits
EDGE_BIT = 0  # 3: the edge belongs to this triangle
CORNER_BIT = 3  # 3: the corner belongs to this triangle
OBTUSE_BIT = 6  # the angle at node C is obtuse
FEATURES = 0b111111  # the bits of edges and corners

# -- Motions.spec
MOTION_KIND = 0  # see minidem.kernels.motion.motion.KINDS
MOTION_FIRST, MOTION_END = 1, 2  # triangles
MOTION_LEADS = 3  # 1 if it is the first motion of its mesh
MOTION_WAVES = 4  # number of waves of a vibration
MOTION_CARRIES = 5  # 1 if the reference point of the mesh goes along
MOTION = 8  # columns

# -- Motions.value, by kind
LINEAR_VELOCITY = 0  # 3: m/s
WIGGLE_AMPLITUDE, WIGGLE_RATE = 0, 3  # 3: m; rad/s
ORIGIN = 0  # 3: point on the axis, m
AXIS = 3  # 3: unit vector
ROTATE_SPIN = 6  # rad/s
RIGGLE_RATE, RIGGLE_AMPLITUDE = 6, 7  # rad/s; rad
WAVES = 8  # the first wave of a vibration, and of each wave
WAVE_AMPLITUDE, WAVE_PHASE, WAVE_RATE = range(3)  # m or rad; rad; rad/s
WAVE = 3  # columns of a wave
MOST_WAVES = 30
MOTION_VALUE = 104  # columns, enough for them

# -- Motions.table
TABLE_SPIN = 0  # of a spin table, rad/s; else a velocity, m/s

# -- Flows.pair: a particle near a flow mesh
NEAR_FLOW, NEAR_TRIANGLE, NEAR_PARTICLE = range(3)
NEAR = 3  # columns

# -- Flows.spec
FLOW_ONCE = 0  # 1 if a particle counts once for good
FLOW_GROUP = 1  # bit
FLOW_TRIANGLE = 2  # the first triangle of its mesh
FLOW_DELETE = 3  # 1 if particles that were counted go
FLOW_OUTLET = 4  # 1 if a point says which side is far, -1 if it is on the near side, 0 without
FLOW = 5  # columns

# -- Flows.value
FLOW_POINT = 0  # 3: on the mesh, m; with `FLOW_OUTLET` the point at the outlet
FLOW_NORMAL = 3  # 3: unit vector to the far side
FLOW_VALUE = 6  # columns

# -- Flows.marker: values
UNSEEN, BEFORE, BEHIND, COUNTED = range(-1, 3)  # the last: for good

# -- Flows.event: a passage
EVENT_FLOW, EVENT_ID, EVENT_STEP = range(3)
EVENT_POSITION = 3  # 3: m
EVENT_VELOCITY = 6  # 3: m/s
EVENT_RADIUS = 9  # m
EVENT_MASS = 10  # kg
EVENT = 12  # columns
EVENT_STATE = slice(EVENT_POSITION, EVENT_RADIUS)  # position and velocity

# -- Posts.spec
POST_KIND = 0  # see minidem.kernels.motion.post.POST_KINDS
POST_GROUP = 1  # bit
POST_AXES = 2  # of setforce: a bit per component
POST = 4  # columns

# -- Posts.value, by kind
POST_VECTOR = 0  # 3: gravity, m/s2; setforce and addforce, N
POST_VISCOUS = 0  # coefficient, kg/s
DRAG_FACTOR, DRAG_DENSITY, DRAG_VISCOSITY = range(3)  # 1; gas, kg/m3; gas, Pa s
DRAG_GAS = 3  # 3: velocity of the gas, m/s
POST_VALUE = 8  # columns

# -- Control.whole
STEP = 0  # the step that is being made or was made last
STOP_STEP = 1  # at which to return
INSERT_STEP = 2  # at which to return for an insertion
ENTRY = 3  # where to go on, see minidem.kernels.control
CODE = 4  # why the loop returned, see minidem.kernels.control
LIST_AGE = 5  # steps since the last rebuild
LIST_DELAY, LIST_EVERY, LIST_CHECK = 6, 7, 8  # of neigh_modify
CLEAR_HISTORY = 9  # 1 if pair history is cleared at separation
PARTICLES = 10  # number of particles
INTEGRATED = 11  # group bits
RENEW_STEP = 12  # at which a moving mesh wants new lists
AIRBORNE_STEP = 13  # the last with particles in flight
FROZEN = 14  # group bit
TYPES = 15  # number of atom types
MOTIONS, FLOWS, POSTS = 16, 17, 18  # how many there are
LEADING = 19  # 1 if the first post is gravity and comes before all walls
NEEDS_PYTHON = 20  # 1 if posts need Python first
TURNED = 21  # which of the two sets of lists is in use
REBUILT = 22  # what the last rebuild in the loop came to, see minidem.kernels.lists.rebuild
BUILDS = 23  # number of rebuilds
LISTED = 24  # particles that the lists in use were made for
LATE_POSTS = 25  # the first post after the walls
PAUSE_STEP = 26  # at which to return before the forces
UNFORCED, UNTURNED, LIMITED = 27, 28, 29  # group bits: no half kicks, no spin, a largest speed
LIMIT_OF_RADIUS = 30  # 1 if that speed is given per radius
WET = 31  # 1 if liquid moves between particles
LOST = 32  # particles that have left the box since Python last looked
LOST_ID, LOST_STEP = 33, 34  # one of the last to do so, and when
SORT_STEP = 35  # from which on to return for new lists, which go with another order
LASTING = 36  # 1 if lists may hold more than LIGGGHTS' would, so that they last
PAIR_MODEL = 40  # the first of the model switches of the pair style
WHOLE = 64  # columns

# -- Control.real
DT = 0  # step, s
TRIGGER2 = 1  # squared move that asks for new lists, m2
REACH2 = 2  # squared contact_distance_factor
LENGTH = 3  # 3: periods, m; 0 in other directions
INVERSE = 6  # 3: their inverses, 1/m, or 0
MOVED2 = 9  # largest squared move found, m2
SKIN, REACH = 10, 11  # of the neighbour list, m; contact_distance_factor
LIMIT2 = 12  # squared largest speed, m2/s2, or 1/s2 if given per radius
SWEPT = 13  # way that a particle may have gone, m, since near pairs were last looked for
LOST_AT = 14  # 3: where the particle of LOST_ID left, m
ALONG = 17  # 3: velocity relative to which SWEPT counts, m/s
WAY = 20  # that a particle may have gone, m, since its position was last held
WIDE = 21  # skin that the lists in use were made with, m
SPENT, WALLS_SPENT = 22, 23  # ways of particles and of meshes since then, without the last, m
TRAVEL = 24  # way that particle and mesh may have come nearer, m, since Python last looked
NEARBY = 25  # distance of a particle from a mesh, m, for which TRAVEL counts how the mesh turns
REAL = 32  # columns

# -- model switches; 0 is off
NORMAL, TANGENTIAL, ROLLING, COHESION = range(4)  # values: see `minidem.kernels.models`
TANGENTIAL_DAMPING, LIMIT_FORCE, TORSION_TORQUE, TANGENTIAL_REDUCE, KT_TO_KN = range(4, 9)
# extensions: friction falls with sliding, restitution with impact speed; restitution is drawn;
# tangential stiffness is another
WEAKENS, SLOWS, SCATTERS, SOFTENS = 9, 10, 11, 12
# of hooke/stiffness; of hooke; of edinburgh; of rolling luding
ABSOLUTE_DAMPING, VISCOUS, FIXED_ADHESION, TORSION = 13, 14, 15, 16
LIMITS_LIQUID, SETS_BRIDGES = 17, 18  # of washino: largest content; part of it in bridges given
BASIC_SWITCHES = 9  # how many there are of models that have loops of their own
SWITCHES = 19  # columns

# -- insertion: state of a generator of random numbers
SEED = 0
KEPT_READY, KEPT_NORMAL = 1, 2  # 1 if a second normal number is kept; that number
# corners of a box, and mean and fluctuation of a velocity
LOWER, UPPER = 0, 1
MEAN, SPREAD = 0, 1
DRAWN, DOMAIN = 0, 1  # of two boxes: that points are drawn in, the simulation box
# Grid.sphere: centre, and in column RADIUS the radius
# regions: see minidem.kernels.insertion.shape_columns
# Face.rim: ends of an edge
RIM_FROM, RIM_TO = 0, 1


def three(first: int) -> slice[int, int, None]:
    """Return the three columns from `first` on, for Python: ``flight[:, three(FLIGHT_FROM)]``."""
    return slice(first, first + 3)
