"""Small scripts as in `model_list` for liquid bridges and for ``thornton_ning``.

Pairs meet head on, oblique and slowly enough to stay together, and part until the bridge between
them breaks; single grains do so with a plane and with a mesh, and thirty fall on one another. The
thermo lines have the smallest and the largest liquid content and the sum.
"""

from __future__ import annotations

from tests.minidem.engine.case_list import PACK, WEIGHT, ball
from tests.minidem.engine.cases import Case, plate
from tests.minidem.laws.model_list import EARLY, POUR, SPHERES, values, walls

LIQUID = {
    "minSeparationDistanceRatio": "scalar 0.01",
    "maxSeparationDistanceRatio": "scalar 1.1",
    "surfaceLiquidContentInitial": "scalar 0.0123456789",
    "surfaceTension": "scalar 0.0728",
    "fluidViscosity": "scalar 0.01",
    "contactAngle": "peratomtype 20 40",
    "maxLiquidContent": "peratomtype 0.01 0.008",
    "lbVolumeFraction": "scalar 0.1",
    "coefficientYieldRatio": "peratomtype 0.15 0.12",
}
"""Values that models with liquid bridges and ``thornton_ning`` take."""
EASO, WASHINO = "cohesion easo/capillary/viscous", "cohesion washino/capillary/viscous"
WATCHED = (
    "run 0\n"
    "compute least all reduce min f_surfaceLiquidContent\n"
    "compute most all reduce max f_surfaceLiquidContent\n"
    "thermo_style custom step atoms ke c_least c_most\n"
    "thermo_modify lost ignore norm no format float %.16g\n"
)
UNLIKE = (
    "run 0\n"
    "set atom 2 property/atom surfaceLiquidContent 0.03\n"
    "set atom 3 property/atom surfaceLiquidContent 0.002\n"
    "set atom 4 property/atom liquidSource 0.1\n"
)
SLOW = (
    ball(1, "0 0 0.01", "0.02 0.01 0", "3 2 1")
    + ball(2, "0.01005 0 0.01", "-0.02 0 0", "0 5 5")
    + ball(3, "0.0205 0.0002 0.0102", "-0.05 0 0", "5 0 1", 0.008)
    + ball(4, "-0.03 0.03 0.00405", "0.01 0 -0.1", "0 0 3", 0.008)
    + ball(5, "-0.07 -0.02 -0.0451", "0.01 0.02 -0.1", "0 5 5")
    + "set atom 3 type 2\n"
)
ACROSS = (
    SLOW.replace("single 0 0 0.01", "single 0.0998 0 0.01")
    .replace("0.01005", "-0.0892")
    .replace("vx 0.02", "vx 0.1")
)
"""Two meet through a periodic face; images are dry at the first setup of LIGGGHTS."""


def liquid() -> str:
    """Return the lines of the values."""
    return "".join(
        f"fix l{k} all property/global {name} {words}\n"
        for k, (name, words) in enumerate(LIQUID.items())
    )


def of_wall(model: str, settings: str) -> tuple[str, str]:
    """Return model and settings of the walls: bridges of ``easo`` are for pairs only."""
    if EASO not in model:
        return model, settings
    return model.replace(EASO, ""), settings.replace("tangential_reduce on", "")


def met(model: str, settings: str = "", grains: str = SPHERES, **more: object) -> Case:
    """Return a case of a few grains; lists are made anew while their contacts last."""
    body = liquid() + values() + grains + WEIGHT + walls(*of_wall(model, settings))
    runs = more.pop("runs", f"{WATCHED}run 3000")
    return Case(
        body, 3000, meshes={"m.stl": plate(0.0, 0.04)}, model=f"{model} {settings}",
        skin=0.0005, runs=str(runs), **more,  # type: ignore[arg-type]
    )  # fmt: skip


def poured(
    model: str, settings: str = "", runs: str = f"{WATCHED}run 3000", steps: int = 3000
) -> Case:
    """Return a case of thirty grains that fall on a plate."""
    body = liquid() + values() + PACK + POUR + WEIGHT + walls(*of_wall(model, settings))
    return Case(
        body, steps, meshes={"m.stl": plate(0.0, 0.04)}, model=f"{model} {settings}",
        skin=0.0005, rtol=EARLY, runs=runs,
    )  # fmt: skip


HERTZ = "hertz tangential history"
NING = "thornton_ning tangential history"
WET_CASES: dict[str, Case] = {
    f"{name}, {case}": made
    for name, words in (("easo", EASO), ("washino", WASHINO))
    for case, made in {
        "collisions": met(f"{HERTZ} {words} rolling_friction epsd2"),
        "slow": met(f"{HERTZ} {words}", "tangential_reduce on", SLOW),
        "unlike grains": met(
            f"hooke tangential history {words}", runs=f"{UNLIKE}{WATCHED}run 3000"
        ),
        "several runs": met(
            f"edinburgh tangential history {words} rolling_friction epsd2",
            "",
            SLOW,
            runs=f"{WATCHED}run 500\nrun 500\nrun 2000",
        ),
        "periodic": met(
            f"{HERTZ} {words}",
            "",
            ACROSS,
            boundary="p p f",
        ),
        "packing": poured(f"{HERTZ} {words}"),
    }.items()
} | {
    "washino, limits": met(f"{HERTZ} {WASHINO}", "limitLiquidContent on modifyLbVolume on", SLOW),
    "washino, walls dry": met(f"{HERTZ} {WASHINO}", "modifyLbVolume on"),
    "thornton_ning": met(NING, runs="run 3000"),
    "thornton_ning, slow": met(f"{NING} rolling_friction epsd2", "", SLOW, runs="run 3000"),
    "thornton_ning, luding": met(
        "thornton_ning tangential tan_luding rolling_friction luding", "", SLOW, runs="run 3000"
    ),
    "thornton_ning, packing": poured(NING, runs="timestep 1e-6\nrun 10000", steps=10000),
    "thornton_ning, easo": met(f"{NING} {EASO}", "", SLOW),
}
