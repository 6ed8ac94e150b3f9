"""Write the rendered scripts that tests compare with: python benchmarks/golden_scripts.py.

Run it after a deliberate change of a template or of an apparatus default, and read the difference.
"""

from __future__ import annotations

from pathlib import Path

from liggghts_io.cases import CaseSpec, script_of

FOLDER = Path(__file__).resolve().parent.parent / "tests" / "data" / "liggghts_io"
PARAMETERS = {
    "mu_pp": 0.694, "mu_roll_pp": 0.0856, "mu_pw": 0.307, "mu_roll_pw": 0.274,
    "e_pp": 0.742, "e_pw": 0.439,
}  # fmt: skip
EFFECTS = {"size_distribution": 1.0, "cohesion_J_m3": 2000.0}


def specs() -> dict[str, CaseSpec]:
    """Return the stored cases by file name."""
    found = {}
    for experiment, surface in (
        ("heap", "steel"), ("heap", "glued"), ("conveyor", "steel"), ("plate_impact", "steel"),
    ):  # fmt: skip
        spec = CaseSpec(experiment, "Carbo HSP13", surface, "quick", PARAMETERS, seed=1)
        found[f"{experiment}_{surface}_quick.in"] = spec
    extended = CaseSpec(
        "conveyor", "Carbo HSP13", "glued", "quick", PARAMETERS, effects=EFFECTS, seed=1
    )
    found["conveyor_glued_quick_effects.in"] = extended
    return found


def main() -> None:
    """Write all of them."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    for name, spec in specs().items():
        (FOLDER / name).write_text(script_of(spec), encoding="utf-8")
        print(FOLDER / name)


if __name__ == "__main__":
    main()
