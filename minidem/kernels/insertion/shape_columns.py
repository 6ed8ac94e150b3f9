"""Columns of `RegionTable.shape`, by style of region, and rows of contacts with a surface.

As in `minidem.kernels.columns` a name in the singular over several columns is the first of them.
"""

from __future__ import annotations

SHAPE = 30  # columns

# of a block: the two sides along X, then Y, then Z
SIDES = 2  # columns per direction
LOW, HIGH = 0, 1
BLOCK_SHAPE = 6  # columns

# of a cylinder, cone and wedge
ROUND_AXIS = 0  # X, Y or Z
ROUND_U, ROUND_V = 1, 2  # centre along the two other axes, m; of a wedge in turn after its own
ROUND_RADIUS = 3  # m; of a cone at its lower end
ROUND_LOW, ROUND_HIGH = 4, 5  # ends along the axis, m
CONE_RADIUS = 6  # of a cone at its upper end, m
WEDGE_FIRST, WEDGE_SECOND = 6, 8  # 2 each: normals of the two flat sides, to the outside
WEDGE_WIDE = 10  # 1 if its angle is above 180 degrees

# of a sphere: centre, and in column RADIUS of minidem.kernels.columns the radius, m

# of a plane
PLANE_POINT, PLANE_NORMAL = 0, 3  # 3 each: a point on it, m; unit vector into the region

# of a prism, which three edges span
PRISM_LOW, PRISM_HIGH = 0, 3  # 3 each: first and opposite corner, m
PRISM_XX, PRISM_XY, PRISM_XZ, PRISM_YY, PRISM_YZ, PRISM_ZZ = range(6, 12)  # inverse of edges, 1/m
PRISM_NORMAL = 12  # 3 times 3: of the faces at the first corner, to the inside
PRISM_EDGE = 21  # 3 times 3: m
VECTOR = 3  # columns of each normal and edge
FACES, EDGES = 6, 4  # how many a prism has, and a face

# of a tetrahedron: corners A, B and C of minidem.kernels.columns, and
LAST = 3

# a row of contacts with the surface of a region, and
CONTACTS, SURFACE_POINT = 7, 6  # rows; the row that holds a point
