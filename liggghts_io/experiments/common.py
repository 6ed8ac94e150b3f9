"""What all experiments with a template of `common.j2` share: parameters and variables."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Final

from liggghts_io.experiments.numbers import Parameter, same
from liggghts_io.experiments.setup import Setup
from liggghts_io.materials import GLUED_FRICTION
from liggghts_io.scripts.filters import Sizes, grains
from liggghts_io.sizes import coarse_restitution, simulated_sizes

_NUMBERS: Final = ("grain_count", "grain_rate")  # an own template may compute them itself

_SIDE: Final = "ours: docs/apparatus.md"
NUISANCE: Final = "nuisance, zero unless it is measured"
FLOW_NUISANCE: Final = (
    "nuisance, one unless measured; appendix B: funnels of one size flow differently"
)
ROOM: Final = "ours, numerical: grains find room where they appear"
SPEED: Final = "ours, numerical: fast; results do not depend on it"
"""Sources of numbers that several experiments have."""


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
            source="Grobbel et al. 2019, section 2.3: below a fifth",
        ),
        same(
            "mu_side",
            "-",
            "sliding friction of grains on walls not under test",
            mu_side,
            (0.0, 1000.0),
            source=_SIDE,
        ),
        same(
            "mu_roll_side",
            "-",
            "rolling friction on walls not under test",
            mu_roll_side,
            (0.0, 1000.0),
            source=_SIDE,
        ),
        same(
            "e_side",
            "-",
            "restitution on walls not under test",
            e_side,
            (0.051, 1.0),
            source=_SIDE,
        ),
    )


def common_variables(setup: Setup) -> dict[str, Any]:
    """Return the variables every template needs: material, contact, gravity, seed.

    Grains are the real ones, all of Sauter diameter; `as_simulated` comes after the experiment.
    """
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
        "rolling_model": "epsd2",
        "plate_rolling_model": "epsd2",
        "torsion": False,
        "cohesive": False,
        "cohesion_pp": 0.0,
        "cohesion_pw": 0.0,
        "static_friction": False,
        "restitution_exponent": 0.0,
        "restitution_scatter": 0.0,
        "tangential_stiffness": 1.0,
        "air_drag": 0.0,
        "extensions": [],
        "gravity": (0.0, 0.0, -1.0),
        "seed": setup.seed,
        "skin": apparatus["skin_d"] * particle.d32_m,
        "frames": apparatus["frames"],
    }


def leaning(x_deg: float, y_deg: float) -> tuple[float, float, float]:
    """Return the direction of gravity in an apparatus that leans towards x and towards y.

    Parameters
    ----------
    x_deg, y_deg : float
        Slopes of its level along x and along y [degrees]; positive ends are the lower ones.
    """
    x, y = math.tan(math.radians(x_deg)), math.tan(math.radians(y_deg))
    length = math.sqrt(1.0 + x * x + y * y)
    return x / length, y / length, -1.0 / length


def with_sizes(variables: Mapping[str, Any], sizes: Sizes) -> dict[str, Any]:
    """Replace the sizes of the grains; their number and rate keep mass and mass flow.

    Parameters
    ----------
    variables : mapping
        Of a build.
    sizes : sequence of (float, float)
        Diameter [m] and mass fraction of each class.
    """
    density = variables["density"]
    ratio = grains(1.0, sizes, density) / grains(1.0, variables["sizes"], density)
    scaled = {name: variables[name] * ratio for name in _NUMBERS if name in variables}
    return {**variables, "sizes": sizes, **scaled}


def as_simulated(variables: Mapping[str, Any], setup: Setup) -> dict[str, Any]:
    """Turn the grains of a build, real and of one size, into those that are simulated.

    The apparatus stays as it is, and so do the poured mass and the mass flow; coarse grains get
    the restitution with which they lose as much energy among themselves as the real ones. Against
    a wall, a glued one too, restitution stays.

    Raises
    ------
    CaseError
        If there is no such restitution, or the measured sizes are asked for and not known.
    """
    particle, contact = setup.particle, setup.contact
    factor = particle.coarse_graining
    sizes = simulated_sizes(particle)
    if sizes == variables["sizes"]:
        return dict(variables)
    changed = with_sizes(variables, sizes) | {"skin": variables["skin"] * factor}
    if "e_pp" in contact:
        changed["e_pp"] = coarse_restitution(contact["e_pp"], factor)
    if "d32_m" in changed:
        changed["d32_m"] = changed["d32_m"] * factor
    return changed


def about_grains(sizes: Sizes, coarse_graining: float) -> str:
    """Return what a script says of its grains; empty for real ones of one size."""
    if len(sizes) == 1 and coarse_graining == 1.0:
        return ""
    diameters = [diameter * 1e3 for diameter, _ in sizes]
    sauter = 1e3 / sum(mass / diameter for diameter, mass in sizes)
    words = [f"Sauter diameter {sauter:.4g} mm"]
    if coarse_graining != 1.0:
        words.append(f"{coarse_graining:g} times that of the real ones")
    if len(sizes) > 1:
        ends = f"{min(diameters):.4g} to {max(diameters):.4g} mm"
        words.append(f"{len(sizes)} classes from {ends}, the smallest sets the time step")
    return f"Grains: {', '.join(words)}."
