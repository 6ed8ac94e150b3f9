"""What the contact law takes and gives, as named tuples; in machine code nothing is left of them.

Lengths in m, velocities in m/s, spins in rad/s, forces in N, torques in N m, masses in kg.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from minidem.kernels.columns import (  # isort: skip
    SX, SY, SZ, MX, MY, MZ, NORMAL, TANGENTIAL, ROLLING, COHESION, TANGENTIAL_DAMPING, LIMIT_FORCE,
    TORSION_TORQUE, TANGENTIAL_REDUCE, KT_TO_KN, WEAKENS, SLOWS, SCATTERS, SOFTENS,
    ABSOLUTE_DAMPING, VISCOUS, FIXED_ADHESION, TORSION, LIMITS_LIQUID, SETS_BRIDGES,
)  # fmt: skip
from minidem.kernels.models import (  # isort: skip
    YOUNG, SHEAR, DAMPING, FRICTION, ROLLING_FRICTION, COHESION_ENERGY, ROLLING_DAMPING,
    LOG_RESTITUTION, CHARACTERISTIC_SPEED,
)  # fmt: skip
from minidem.kernels.machine.jit import inlined

__all__ = [
    "Contact",
    "Gap",
    "Load",
    "Material",
    "Memory",
    "Reaction",
    "Switches",
    "material",
    "recall",
    "remember",
    "switches",
]


class Switches(NamedTuple):
    """Which model each part of the law follows; 0 is off.

    Attributes
    ----------
    normal, tangential, rolling, cohesion : int
        See `minidem.kernels.models`.
    tangential_damping, limit_force, torsion_torque, tangential_reduce, kt_to_kn : int
        1 on.
    static_friction, velocity_restitution, restitution_scatter, tangential_stiffness : int
        1 if friction falls with the sliding speed; if restitution falls with the impact speed; if
        it differs from contact to contact; if the tangential stiffness is not that of Mindlin.
        Extensions of minidem.
    absolute_damping, viscous, fixed_adhesion, torsion, limits_liquid, sets_bridges : int
        1 if damping is not per mass (hooke/stiffness); if restitution follows from a fluid (hooke,
        hooke/hysteresis); if the stiffness of adhesion is given (edinburgh); if torsion is
        resisted (rolling luding); if the liquid of a particle is limited, or the part of it in
        bridges given (washino).
    """

    normal: int
    tangential: int
    rolling: int
    cohesion: int
    tangential_damping: int
    limit_force: int
    torsion_torque: int
    tangential_reduce: int
    kt_to_kn: int
    static_friction: int = 0
    velocity_restitution: int = 0
    restitution_scatter: int = 0
    tangential_stiffness: int = 0
    absolute_damping: int = 0
    viscous: int = 0
    fixed_adhesion: int = 0
    torsion: int = 0
    limits_liquid: int = 0
    sets_bridges: int = 0


class Material(NamedTuple):
    """Coefficients of a pair of types.

    Attributes
    ----------
    young, shear : float
        Effective moduli, Pa.
    damping : float
        ``-2 sqrt(5/6) B`` with ``B = ln e / sqrt(ln(e)^2 + pi^2)``.
    friction, rolling : float
        Coefficients of sliding and rolling friction.
    cohesion : float
        Cohesion energy density, J/m3.
    rolling_damping : float
        Viscous ratio of rolling (epsd).
    log_restitution : float
        ``ln e``.
    speed : float
        Characteristic velocity (hooke), m/s.
    """

    young: float
    shear: float
    damping: float
    friction: float
    rolling: float
    cohesion: float
    rolling_damping: float
    log_restitution: float
    speed: float


class Contact(NamedTuple):
    """Geometry and motion of one contact.

    Attributes
    ----------
    overlap : float
        m.
    area : float
        That the cohesion acts on, m2.
    radius, mass, inertia : float
        Effective radius, m, mass, kg, and moment of inertia for rolling, kg m2.
    nx, ny, nz : float
        Unit normal from j to i.
    dx, dy, dz : float
        From the centre of j, or the point of the wall, to the centre of i, m.
    vx, vy, vz : float
        Velocity of i relative to j, m/s.
    wx, wy, wz : float
        Weighted spin ``(cri wi + crj wj) / r``, rad/s.
    ux, uy, uz : float
        Relative spin, rad/s.
    """

    overlap: float
    area: float
    radius: float
    mass: float
    inertia: float
    nx: float
    ny: float
    nz: float
    dx: float
    dy: float
    dz: float
    vx: float
    vy: float
    vz: float
    wx: float
    wy: float
    wz: float
    ux: float
    uy: float
    uz: float


class Memory(NamedTuple):
    """What a contact keeps.

    Attributes
    ----------
    sx, sy, sz : float
        Tangential displacement, m.
    mx, my, mz : float
        Spring torque of rolling, N m.
    """

    sx: float
    sy: float
    sz: float
    mx: float
    my: float
    mz: float


class Load(NamedTuple):
    """What the normal model gives to those that come after it.

    Attributes
    ----------
    kn, kt, gt : float
        Stiffness, N/m; tangential damping, kg/s.
    elastic, force : float
        Elastic part, and the whole normal force, N.
    held : float
        What tan_luding and rolling luding add to it where they take it for a limit, N.
    slide_stiffness, slide_damping : float
        Of tan_luding, over kt and gt.
    slip : float
        Its dynamic over its static friction.
    roll_stiffness : float
        Factor of epsd3, or of luding.
    turn : float
        Of a wall, the spin of the particle over `Contact.ux`; 0 between particles.
    pull, drag : float
        Of a liquid bridge: normal force, N, and drag along the surfaces, kg/s, both below zero.
    """

    kn: float
    kt: float
    gt: float
    elastic: float
    force: float
    held: float
    slide_stiffness: float
    slide_damping: float
    slip: float
    roll_stiffness: float
    turn: float
    pull: float
    drag: float


class Reaction(NamedTuple):
    """What a contact does.

    Attributes
    ----------
    fx, fy, fz : float
        Force on i, N.
    tx, ty, tz : float
        Unit normal times tangential force, N; with the lever arms the torques of i and j.
    rx, ry, rz : float
        Rolling torque, N m; taken from i and given to j.
    """

    fx: float
    fy: float
    fz: float
    tx: float
    ty: float
    tz: float
    rx: float
    ry: float
    rz: float


class Gap(NamedTuple):
    """Where the surface of a wall is, seen from a particle.

    Attributes
    ----------
    distance : float
        From the nearest point of the wall to the centre, m.
    dx, dy, dz : float
        The same as a vector, m.
    ux, uy, uz : float
        Velocity of the wall there, m/s.
    """

    distance: float
    dx: float
    dy: float
    dz: float
    ux: float
    uy: float
    uz: float


@inlined
def switches(words: Any, first: int) -> Any:
    """Return the `Switches` that a row holds from column `first` on."""
    return Switches(
        words[first + NORMAL], words[first + TANGENTIAL], words[first + ROLLING],
        words[first + COHESION], words[first + TANGENTIAL_DAMPING], words[first + LIMIT_FORCE],
        words[first + TORSION_TORQUE], words[first + TANGENTIAL_REDUCE], words[first + KT_TO_KN],
        words[first + WEAKENS], words[first + SLOWS], words[first + SCATTERS],
        words[first + SOFTENS], words[first + ABSOLUTE_DAMPING], words[first + VISCOUS],
        words[first + FIXED_ADHESION], words[first + TORSION], words[first + LIMITS_LIQUID],
        words[first + SETS_BRIDGES],
    )  # fmt: skip


@inlined
def material(coef: Any, q: int) -> Any:
    """Return the `Material` in row q of the coefficients."""
    return Material(
        coef[q, YOUNG], coef[q, SHEAR], coef[q, DAMPING], coef[q, FRICTION],
        coef[q, ROLLING_FRICTION], coef[q, COHESION_ENERGY], coef[q, ROLLING_DAMPING],
        coef[q, LOG_RESTITUTION], coef[q, CHARACTERISTIC_SPEED],
    )  # fmt: skip


@inlined
def recall(hist: Any, k: int) -> Any:
    """Return the `Memory` in row k of a table of histories."""
    if hist.shape[1] <= MX:
        return Memory(hist[k, SX], hist[k, SY], hist[k, SZ], 0.0, 0.0, 0.0)
    return Memory(hist[k, SX], hist[k, SY], hist[k, SZ], hist[k, MX], hist[k, MY], hist[k, MZ])


@inlined
def remember(hist: Any, k: int, memory: Any) -> None:
    """Write a `Memory` to row k of a table of histories."""
    hist[k, SX] = memory.sx
    hist[k, SY] = memory.sy
    hist[k, SZ] = memory.sz
    if hist.shape[1] <= MX:
        return
    hist[k, MX] = memory.mx
    hist[k, MY] = memory.my
    hist[k, MZ] = memory.mz
