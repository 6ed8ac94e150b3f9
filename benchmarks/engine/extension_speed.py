"""Compare the CPU time of the extended contact laws with that of their base model.

    python benchmarks/engine/extension_speed.py [--repeat 3]

A pile of 300 disks over 30 000 steps, second run of each script in this process, so that nothing is
compiled or loaded; the smallest of the repeats.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from minidem import run_script
from tests.minidem.laws import pile_scripts as piles

MODEL = "hertz tangential history rolling_friction epsd2"
VALUES = """fix e1 all property/global coefficientStaticFriction peratomtypepair 1 1.0
fix e2 all property/global weakeningVelocity scalar 0.01
fix e3 all property/global restitutionExponent peratomtypepair 1 0.1
fix e4 all property/global restitutionVelocity scalar 0.1
fix e5 all property/global restitutionDeviation peratomtypepair 1 0.1
fix e6 all property/global tangentialStiffnessFactor peratomtypepair 1 0.8
pair_coeff"""


def script(settings: str, drag: str) -> str:
    """Return the pile with settings in the pair style, or with another fix."""
    text = piles.column(MODEL, np.random.default_rng(1), 300, (0.5, 1.0, 20))
    text = text.replace("pair_coeff", VALUES)
    text = text.replace(
        f"pair_style gran model {MODEL}", f"pair_style gran model {MODEL} {settings}"
    )
    return text.replace("fix motion", f"{drag}\nfix motion")


def cpu_s(text: str) -> float:
    """Return the CPU time of a script, s."""
    with tempfile.TemporaryDirectory() as name:
        (Path(name) / "in.pile").write_text(text)
        before = time.process_time()
        run_script(Path(name) / "in.pile", root=Path(name))
        return time.process_time() - before


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--repeat", type=int, default=3)
    chosen = parser.parse_args()
    scripts = {
        "base model": script("", ""),
        "drag/sphere": script("", "fix air all drag/sphere density 1.204 viscosity 1.81e-5"),
        "staticFriction": script("staticFriction on", ""),
        "velocityRestitution": script("velocityRestitution on", ""),
        "restitutionScatter": script("restitutionScatter on", ""),
        "tangentialStiffness": script("tangentialStiffness on", ""),
        "all four": script(
            "staticFriction on velocityRestitution on restitutionScatter on tangentialStiffness on",
            "",
        ),
    }
    times = {
        name: [cpu_s(text) for _ in range(chosen.repeat + 1)] for name, text in scripts.items()
    }
    print("| contact law | CPU time (s) | over the base model |")
    print("|---|---|---|")
    base = min(times["base model"][1:])
    for name, found in times.items():
        best = min(found[1:])
        print(f"| {name} | {best:.2f} | {best / base:.2f} |")


if __name__ == "__main__":
    main()
