"""Write the rendered scripts that tests compare with: python benchmarks/engine/golden_scripts.py.

Run it after a deliberate change of a template or of an apparatus default, and read the difference.
"""

from __future__ import annotations

from pathlib import Path

from calibrate.study.resources import bundled_particles
from liggghts_io import CaseSpec, particle_named
from liggghts_io.case.spec import script_of

FOLDER = Path(__file__).resolve().parents[2] / "tests" / "data" / "liggghts_io"
GRAIN = particle_named("Carbo HSP13", bundled_particles())
PARAMETERS = {
    "mu_pp": 0.694, "mu_roll_pp": 0.0856, "mu_pw": 0.307, "mu_roll_pw": 0.274,
    "e_pp": 0.742, "e_pw": 0.439,
}  # fmt: skip
EFFECTS = {"size_distribution": 1.0, "cohesion_J_m3": 2000.0}
EXTENSIONS = {
    "air_drag": 1.0, "restitution_scatter": 0.1, "restitution_slope": 0.25,
    "static_friction_ratio": 0.2, "tangential_stiffness": -0.25,
}  # fmt: skip


def specs() -> dict[str, CaseSpec]:
    """Return the stored cases by file name."""
    found = {}
    for experiment, surface in (
        ("heap", "steel"), ("heap", "glued"), ("conveyor", "steel"), ("plate_impact", "steel"),
    ):  # fmt: skip
        spec = CaseSpec(experiment, GRAIN, surface, "quick", PARAMETERS, seed=1)
        found[f"{experiment}_{surface}_quick.in"] = spec
    for experiment, surface, effects, name in (
        ("conveyor", "glued", EFFECTS, "effects"), ("heap", "steel", EXTENSIONS, "extensions"),
    ):  # fmt: skip
        found[f"{experiment}_{surface}_quick_{name}.in"] = CaseSpec(
            experiment, GRAIN, surface, "quick", PARAMETERS, effects=effects, seed=1
        )
    return found


def main() -> None:
    """Write all of them."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    for name, spec in specs().items():
        (FOLDER / name).write_text(script_of(spec), encoding="utf-8")
        print(FOLDER / name)


if __name__ == "__main__":
    main()
