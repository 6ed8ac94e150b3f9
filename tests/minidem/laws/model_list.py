"""Small scripts as in `tests.minidem.engine.cases` for contact models that few scripts have.

Five spheres of two types and several sizes: a head-on and an oblique collision of pairs, one sphere
on a plane and one on a mesh, with spin; and for some models a small packing. All are served by the
loop of all models, so that nothing is compiled for them.
"""

from __future__ import annotations

from collections.abc import Mapping

from tests.minidem.engine.case_list import PACK, WEIGHT, ball
from tests.minidem.engine.cases import Case, plate

PAIRS: Mapping[str, tuple[float, float, float]] = {
    "kn": (8000.0, 5000.0, 6000.0),
    "kt": (5000.0, 4000.0, 3000.0),
    "gamman": (800.0, 500.0, 300.0),
    "gammat": (300.0, 200.0, 100.0),
    "gamman_abs": (0.4, 0.3, 0.2),
    "gammat_abs": (0.2, 0.1, 0.05),
    "FluidViscosity": (0.6, 0.7, 0.8),
    "CriticalStokes": (1.0, 0.8, 0.5),
    "MaximumRestitution": (0.8, 0.7, 0.9),
    "LoadingStiffness": (3000.0, 4000.0, 3500.0),
    "UnloadingStiffness": (4.0, 5.0, 3.0),
    "coefficientMaxElasticStiffness": (5.0, 4.0, 3.0),
    "coefficientAdhesionStiffness": (0.3, 0.2, 0.1),
    "coefficientPlasticityDepth": (0.02, 0.01, 0.03),
    "pullOffForce": (-0.001, -0.002, 0.001),
    "surfaceEnergy": (0.5, 0.3, 0.4),
    "FrictionViscosity": (0.7, 0.5, 0.6),
    "coeffFrictionStiffness": (0.4, 0.5, 0.3),
    "coeffRollingStiffness": (0.2, 0.1, 0.15),
}
"""Values of the pairs of types 1 1, 1 2 and 2 2."""
SCALARS = {
    "characteristicVelocity": 1.0,
    "rollingStiffness": 1.7,
    "overlapExponent": 1.5,
    "adhesionExponent": 1.5,
}
SPHERES = (
    ball(1, "0 0 0.01", "0.05 0.1 -0.3", "3 2 1")
    + ball(2, "0.0101 0 0.0105", "-0.4 0 -0.1", "0 20 5")
    + ball(3, "0.03 0.03 0.0049", "0.2 -0.1 -0.3", "5 30 40", 0.008)
    + ball(4, "0 0.012 0.02", "0 -0.4 -0.5", "10 0 3", 0.007)
    + ball(5, "-0.07 -0.02 -0.0451", "0.1 0.2 -0.5", "0 5 50")
    + "set atom 3 type 2\n"
)
POUR = (
    "region low block -0.015 0.015 -0.015 0.015 0.001 0.03 units box\n"
    "fix ins all insert/pack seed 32452867 distributiontemplate pd insert_every once "
    "overlapcheck yes all_in yes vel constant 0 0 -0.5 particles_in_region 30 region low\n"
)
EARLY = 1e-8
"""Of a packing: rounding of coordinates (1e-17 m) grows in its contacts."""


def values() -> str:
    """Return the lines of all values."""
    lines = [
        f"fix q{k} all property/global {name} peratomtypepair 2 {a} {b} {b} {c}\n"
        for k, (name, (a, b, c)) in enumerate(PAIRS.items())
    ]
    lines += [
        f"fix r{k} all property/global {name} scalar {value}\n"
        for k, (name, value) in enumerate(SCALARS.items())
    ]
    return "".join(lines)


def walls(model: str, settings: str) -> str:
    """Return a plane below a plate of two triangles."""
    return (
        f"fix floor all wall/gran model {model} primitive type 2 zplane -0.05 {settings}\n"
        "fix cad all mesh/surface file m.stl type 2\n"
        f"fix plates all wall/gran model {model} mesh n_meshes 1 meshes cad {settings}\n"
    )


def collisions(model: str, settings: str = "", **more: float) -> Case:
    """Return a case of single contacts; lists are made anew while they last."""
    body = values() + SPHERES + WEIGHT + walls(model, settings)
    return Case(
        body, 3000, meshes={"m.stl": plate(0.0, 0.04)}, model=f"{model} {settings}",
        skin=0.0005, **more,
    )  # fmt: skip


def packing(model: str, settings: str = "") -> Case:
    """Return a case of thirty spheres that fall on a plate."""
    body = values() + PACK + POUR + WEIGHT + walls(model, settings)
    return Case(
        body, 3000, meshes={"m.stl": plate(0.0, 0.04)}, model=f"{model} {settings}",
        skin=0.0005, rtol=EARLY,
    )  # fmt: skip


FULL = "tangential tan_luding rolling_friction luding"
MODEL_CASES: dict[str, Case] = {
    "hooke/stiffness": collisions("hooke/stiffness tangential history"),
    "hooke/stiffness, absolute damping": collisions(
        "hooke/stiffness tangential history rolling_friction cdt", "absolute_damping on"
    ),
    "hooke/stiffness, no tangential damping, no pull": collisions(
        "hooke/stiffness tangential history rolling_friction epsd2",
        "tangential_damping off limitForce on",
    ),
    "hooke/stiffness, packing": packing("hooke/stiffness tangential history"),
    "hertz/stiffness": collisions("hertz/stiffness tangential history rolling_friction epsd"),
    "hertz/stiffness, cohesion": collisions("hertz/stiffness tangential no_history cohesion sjkr"),
    "epsd3": collisions("hertz tangential history rolling_friction epsd3"),
    "epsd3 with torsion, hooke/stiffness": collisions(
        "hooke/stiffness tangential history rolling_friction epsd3", "torsionTorque on"
    ),
    "viscous hooke": collisions("hooke tangential history rolling_friction cdt", "viscous on"),
    "hooke/hysteresis": collisions("hooke/hysteresis tangential history rolling_friction epsd2"),
    "viscous hooke/hysteresis": collisions(
        "hooke/hysteresis tangential history", "viscous on ktToKnUser on"
    ),
    "hooke/hysteresis, packing": packing("hooke/hysteresis tangential history"),
    "luding": collisions("luding tangential history rolling_friction epsd"),
    "luding, all of it": collisions(f"luding {FULL}"),
    "luding with torsion": collisions(f"luding {FULL}", "torsion on limitForce off"),
    "luding, packing": packing(f"luding {FULL}"),
    "edinburgh": collisions("edinburgh tangential history rolling_friction epsd2"),
    "edinburgh, adhesion of a given stiffness": collisions(
        "edinburgh tangential history rolling_friction cdt", "fixKc on"
    ),
    "edinburgh, packing": packing("edinburgh tangential history rolling_friction epsd2"),
    "edinburgh/stiffness": collisions("edinburgh/stiffness tangential history"),
    "edinburgh/stiffness, friction of luding": collisions(
        f"edinburgh/stiffness {FULL}", "fixKc on torsion on"
    ),
}
