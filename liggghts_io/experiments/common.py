"""What all experiments with a template of `common.j2` share: parameters and variables."""

from __future__ import annotations

from typing import Any

from liggghts_io.experiments.numbers import Parameter, same
from liggghts_io.experiments.setup import Setup
from liggghts_io.materials import GLUED_FRICTION


def common_parameters(
    mu_side: float = 0.0, mu_roll_side: float = 0.0, e_side: float = 0.5
) -> tuple[Parameter, ...]:
    """Return the parameters every experiment has; walls not under test are smooth by default."""
    return (
        same(
            "timestep_fraction",
            "-",
            "time step as a part of the Rayleigh time (eq. 6)",
            0.2,
            (1e-3, 0.3),
        ),
        same(
            "mu_side",
            "-",
            "sliding friction of grains on walls not under test",
            mu_side,
            (0.0, 1000.0),
        ),
        same(
            "mu_roll_side",
            "-",
            "rolling friction on walls not under test",
            mu_roll_side,
            (0.0, 1000.0),
        ),
        same("e_side", "-", "restitution on walls not under test", e_side, (0.051, 1.0)),
    )


def common_variables(setup: Setup) -> dict[str, Any]:
    """Return the variables every template needs: material, contact, gravity, seed."""
    contact, apparatus, particle = setup.contact, setup.apparatus, setup.particle
    wall = (
        {"mu_pw": GLUED_FRICTION, "mu_roll_pw": GLUED_FRICTION, "e_pw": contact["e_pp"]}
        if setup.glued
        else {name: contact[name] for name in ("mu_pw", "mu_roll_pw", "e_pw")}
    )
    return {
        "sizes": [(particle.d32_m, 1.0)],
        "density": particle.density,
        "youngs_modulus": particle.youngs_modulus,
        "poisson_ratio": particle.poisson_ratio,
        **{name: contact[name] for name in ("mu_pp", "mu_roll_pp", "e_pp")},
        **wall,
        **{name: apparatus[name] for name in ("mu_side", "mu_roll_side", "e_side")},
        "timestep_fraction": apparatus["timestep_fraction"],
        "cohesive": False,
        "cohesion_pp": 0.0,
        "cohesion_pw": 0.0,
        "static_friction": False,
        "restitution_exponent": 0.0,
        "air_drag": 0.0,
        "extensions": [],
        "gravity": (0.0, 0.0, -1.0),
        "seed": setup.seed,
        "skin": apparatus["skin_d"] * particle.d32_m,
        "frames": apparatus["frames"],
    }
