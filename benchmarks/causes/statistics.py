"""How often the diagnosis is right on a rig of formulas (tests/calibrate/causes/planted.py).

    python benchmarks/causes/statistics.py tests/data/causes/statistics.csv --studies 10

Parameters, errors and stated errors are drawn anew in every study. One row per hidden cause and
strength, in ordinary strengths.
"""

from __future__ import annotations

import argparse
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np
import pandas as pd

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from calibrate.causes.diagnosis import Options, diagnose
from calibrate.causes.verdict import Levels
from tests.calibrate.causes.planted import study

HIDDEN = (("", 0.0), ("tilt", 1.5), ("tilt", 3.0), ("flow", 3.0), ("cohesion", 2.0),
          ("cohesion", 4.0))  # fmt: skip
OPTIONS = Options(Levels(studies=100), held_out=False)


def one(hidden: str, strength: float, number: int) -> dict[str, object]:
    """Diagnose one study."""
    rng = np.random.default_rng([HIDDEN.index((hidden, strength)), number])
    found = diagnose(study({hidden: strength} if hidden else {}, rng), rng, options=OPTIONS)
    verdict = found.verdict
    inside = False
    if hidden:
        scale = found.board.members([hidden])[0].scale
        span = found.interval(hidden)
        inside = span.low <= strength * scale <= span.high
    return {
        "hidden": hidden or "none",
        "strength": strength,
        "named right": verdict.names == (hidden,) and verdict.kind == "named",
        "in group": hidden in verdict.names,
        "in set": (hidden or "none") in verdict.credible,
        "none": verdict.kind == "none",
        "unknown": verdict.kind == "unknown",
        "named wrong": verdict.kind == "named" and verdict.names != (hidden,),
        "probability": verdict.probabilities[hidden or "none"],
        "strength inside": inside,
    }


def main() -> None:
    """Write the table."""
    parser = argparse.ArgumentParser()
    parser.add_argument("out", type=Path)
    parser.add_argument("--studies", type=int, default=10)
    asked = parser.parse_args()
    with ProcessPoolExecutor(2) as pool:
        tasks = [pool.submit(one, *h, k) for k in range(asked.studies) for h in HIDDEN]
        rows = pd.DataFrame([task.result() for task in tasks])
    table = rows.groupby(["hidden", "strength"], sort=False).mean(numeric_only=False)
    table.insert(0, "studies", asked.studies)
    asked.out.parent.mkdir(parents=True, exist_ok=True)
    path = asked.out.resolve().relative_to(Path(__file__).resolve().parents[2])
    head = f"# python benchmarks/causes/statistics.py {path} --studies {asked.studies}\n"
    asked.out.write_text(head + table.to_csv(float_format="%.3g"), encoding="utf-8")


if __name__ == "__main__":
    main()
