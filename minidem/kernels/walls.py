"""Forces of walls on particles: primitive planes and cylinders, and triangle meshes."""

from __future__ import annotations

from math import sqrt

from minidem.kernels.jit import inlined, kernel
from minidem.kernels.law import contact_law, wall_area
from minidem.kernels.triangle import closest, coplanar

__all__ = ["wall_forces"]

EARLIER = 1
HANDLED = 2


@inlined
def _push(parts, coef, types, i, spec, base, wall_type, hist, k,
          dx, dy, dz, r, ux, uy, uz, update, dt):  # fmt: skip
    """Add the force of one wall contact to particle i and return it."""
    row = parts.row
    radius = row[i, 3]
    mass = row[i, 7]
    overlap = radius - r
    nx = dx / r
    ny = dy / r
    nz = dz / r
    area = 0.0
    if spec[base + 3] != 0:
        area = wall_area(spec[base + 3], r, radius, overlap)
    arm = radius - 0.5 * overlap
    lever = arm / r
    wx = lever * parts.spin[i, 0]
    wy = lever * parts.spin[i, 1]
    wz = lever * parts.spin[i, 2]
    out = contact_law(
        spec[base], spec[base + 1], spec[base + 2], spec[base + 3], spec[base + 4],
        spec[base + 5], spec[base + 6], spec[base + 7], spec[base + 8],
        coef, parts.kind[i] * types + wall_type, update, dt, overlap, area, radius, mass,
        1.4 * mass * radius * radius, nx, ny, nz, dx, dy, dz,
        row[i, 4] - ux, row[i, 5] - uy, row[i, 6] - uz, wx, wy, wz, wx, wy, wz,
        hist[k, 0], hist[k, 1], hist[k, 2], hist[k, 3], hist[k, 4], hist[k, 5],
    )  # fmt: skip
    force = parts.force
    force[i, 0] += out[0]
    force[i, 1] += out[1]
    force[i, 2] += out[2]
    force[i, 3] -= arm * out[3] + out[6]
    force[i, 4] -= arm * out[4] + out[7]
    force[i, 5] -= arm * out[5] + out[8]
    for c in range(6):
        hist[k, c] = out[9 + c]
    return out[0], out[1], out[2]


@inlined
def _clear(hist, k):
    for c in range(6):
        hist[k, c] = 0.0


@inlined
def _primitive(parts, walls, coef, types, i, k, w, update, dt):
    """One particle against one plane or cylinder."""
    x = parts.row[i, 0]
    y = parts.row[i, 1]
    z = parts.row[i, 2]
    value = walls.value
    spec = walls.prim[w]
    ux = value[w, 3]
    uy = value[w, 4]
    uz = value[w, 5]
    axis = spec[1]
    if spec[0] == 0:
        d = parts.row[i, axis] - value[w, 0]
        dx = d if axis == 0 else 0.0
        dy = d if axis == 1 else 0.0
        dz = d if axis == 2 else 0.0
        r = abs(d)
    else:
        px = 0.0 if axis == 0 else x - (value[w, 1] if axis == 2 else value[w, 2])
        py = 0.0 if axis == 1 else y - (value[w, 1] if axis == 0 else value[w, 2])
        pz = 0.0 if axis == 2 else z - (value[w, 1] if axis == 1 else value[w, 2])
        far = sqrt(px * px + py * py + pz * pz)
        scale = (far - value[w, 0]) / far if far > 0.0 else 0.0
        dx = px * scale
        dy = py * scale
        dz = pz * scale
        r = abs(far - value[w, 0]) if far > 0.0 else 1.0e30
        if spec[4] == 1 and far > 0.0:  # turning about its own axis: velocity = spin x radius
            spin = value[w, 6]
            ux = spin * (pz if axis == 1 else -py) if axis != 0 else 0.0
            uy = spin * (px if axis == 2 else -pz) if axis != 1 else 0.0
            uz = spin * (py if axis == 0 else -px) if axis != 2 else 0.0
    if r <= parts.row[i, 3] and r > 0.0:
        _push(parts, coef, types, i, spec, 5, spec[2], walls.hist, k,
              dx, dy, dz, r, ux, uy, uz, update, dt)  # fmt: skip
        walls.touch[k] = 1
    elif walls.touch[k] != 0:
        walls.touch[k] = 0
        _clear(walls.hist, k)


@inlined
def _inherit(walls, mesh, k, lo, hi, face):
    """Prepare the history of a new contact; return False if a coplanar neighbour has it already."""
    t = walls.code[k]
    m = mesh.owner[t]
    _clear(walls.hist, k)
    if face == 0:
        return True
    source = k
    for other in range(lo, hi):
        u = walls.code[other]
        if other == k or u < 0 or walls.touch[other] == 0 or mesh.owner[u] != m:
            continue
        if coplanar(mesh.node, mesh.normal, t, u, walls.curve[m]):
            if walls.touch[other] & HANDLED:
                return False
            source = other
    if source != k:
        for c in range(6):
            walls.hist[k, c] = walls.hist[source, c]
    return True


@inlined
def _facet(parts, walls, mesh, coef, types, i, k, lo, hi, update, dt):
    """One particle against one triangle."""
    t = walls.code[k]
    x = parts.row[i, 0]
    y = parts.row[i, 1]
    z = parts.row[i, 2]
    r, dx, dy, dz, w0, w1, w2, face = closest(
        mesh.node, mesh.edge, mesh.length, mesh.normal, mesh.flags, mesh.bound, t, x, y, z
    )
    if not r <= parts.row[i, 3] or r == 0.0:
        return
    if walls.touch[k] == 0 and not _inherit(walls, mesh, k, lo, hi, face):
        return
    walls.touch[k] = EARLIER | HANDLED
    m = mesh.owner[t]
    spec = walls.mesh[m]
    ux = 0.0
    uy = 0.0
    uz = 0.0
    if spec[4] == 1:
        v = mesh.vel
        ux = w0 * v[t, 0, 0] + w1 * v[t, 1, 0] + w2 * v[t, 2, 0]
        uy = w0 * v[t, 0, 1] + w1 * v[t, 1, 1] + w2 * v[t, 2, 1]
        uz = w0 * v[t, 0, 2] + w1 * v[t, 1, 2] + w2 * v[t, 2, 2]
    fx, fy, fz = _push(parts, coef, types, i, spec, 5, spec[2], walls.hist, k,
                       dx, dy, dz, r, ux, uy, uz, update, dt)  # fmt: skip
    load = walls.load
    load[m, 0] -= fx
    load[m, 1] -= fy
    load[m, 2] -= fz
    px = x - dx - mesh.origin[m, 0]
    py = y - dy - mesh.origin[m, 1]
    pz = z - dz - mesh.origin[m, 2]
    load[m, 3] -= py * fz - pz * fy
    load[m, 4] -= pz * fx - px * fz
    load[m, 5] -= px * fy - py * fx


@kernel
def wall_forces(n, parts, walls, mesh, coef, types, update, dt):
    """Add the forces of all walls to the particles and keep the wall histories.

    Parameters
    ----------
    n : int
        Particles.
    parts, walls, mesh : tables
        See `minidem.kernels.tables`.
    coef : float64 (types**2, columns)
        Contact coefficients.
    types : int
        Number of atom types.
    update : int
        1 in a step, 0 at setup.
    dt : float
        Time step, s.
    """
    walls.load[:, :] = 0.0
    for i in range(n):
        lo = walls.start[i]
        hi = walls.start[i + 1]
        if lo == hi:
            continue
        meshes = 0
        for k in range(lo, hi):
            w = walls.code[k]
            if w < 0:
                if parts.mask[i] & walls.prim[-1 - w, 3]:
                    _primitive(parts, walls, coef, types, i, k, -1 - w, update, dt)
            else:
                meshes = 1
                _facet(parts, walls, mesh, coef, types, i, k, lo, hi, update, dt)
        if meshes == 0:
            continue
        for k in range(lo, hi):
            if walls.code[k] < 0:
                continue
            if walls.touch[k] & HANDLED:
                walls.touch[k] = EARLIER
            elif walls.touch[k] != 0:
                walls.touch[k] = 0
                _clear(walls.hist, k)
