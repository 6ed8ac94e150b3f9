"""How often the diagnosis is right on a rig of formulas (tests/calibrate/causes/planted.py).

    python benchmarks/causes/error_rates.py tests/data/causes/statistics.csv --studies 8 --nulls 24

Parameters, errors and stated errors are drawn anew in every study. One row per hidden cause and
strength, in ordinary strengths; all columns but the first three are shares of the studies, or
means. Without a cause, p are right if a tenth of them lies below 0.1 and half of them below 0.5.
"""

from __future__ import annotations

import argparse
import sys
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path

import numpy as np
import pandas as pd

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from calibrate.causes.diagnosis import Options, diagnose
from calibrate.causes.judging.levels import Levels
from tests.calibrate.causes.planted import study

HIDDEN = (("", 0.0), ("tilt", 1.5), ("tilt", 3.0), ("flow", 3.0), ("cohesion", 2.0),
          ("cohesion", 4.0))  # fmt: skip
LEVELS = (0.03, 0.1, 0.5)
OPTIONS = Options(Levels(studies=1000), held_out=False)


def one(hidden: str, strength: float, number: int) -> dict[str, object]:
    """Diagnose one study."""
    rng = np.random.default_rng([HIDDEN.index((hidden, strength)), number])
    found = diagnose(study({hidden: strength} if hidden else {}, rng), rng, options=OPTIONS)
    verdict, chances = found.verdict, found.verdict.chances
    inside = False
    if hidden:
        scale = found.board.members([hidden])[0].scale
        span = found.interval(hidden)
        inside = span.low <= strength * scale <= span.high
    return {
        "hidden": hidden or "none",
        "strength": strength,
        "named right": verdict.names == (hidden,) and verdict.kind == "named",
        "in name or set": hidden in verdict.names,
        "none": verdict.kind == "none",
        "unknown": verdict.kind == "unknown",
        "named wrong": verdict.kind == "named" and hidden not in verdict.names,
        "probability": verdict.answers.single[hidden or "none"],
        "strength inside": inside,
        **{
            f"{name} below {level:g}": p < level
            for name, p in (("p_best", chances.p_best), ("p_misfit", chances.p_misfit))
            for level in LEVELS
        },
    }


def main() -> None:
    """Write the table."""
    parser = argparse.ArgumentParser()
    parser.add_argument("out", type=Path)
    parser.add_argument("--studies", type=int, default=10)
    parser.add_argument("--nulls", type=int, default=10)
    parser.add_argument("--workers", type=int, default=2)
    asked = parser.parse_args()
    path = asked.out.resolve().relative_to(Path(__file__).resolve().parents[2])
    head = (
        f"# python benchmarks/causes/error_rates.py {path} "
        f"--studies {asked.studies} --nulls {asked.nulls}\n"
    )
    asked.out.parent.mkdir(parents=True, exist_ok=True)
    most = max(asked.studies, asked.nulls)
    todo = [(h, k) for k in range(most) for h in HIDDEN
            if k < (asked.studies if h[0] else asked.nulls)]  # fmt: skip
    rows: list[dict[str, object]] = []
    with ProcessPoolExecutor(asked.workers) as pool:
        for task in as_completed([pool.submit(one, *h, k) for h, k in todo]):
            rows.append(task.result())
            groups = pd.DataFrame(rows).groupby(["hidden", "strength"])
            table = groups.mean(numeric_only=False)
            table.insert(0, "studies", groups.size())
            asked.out.write_text(head + table.to_csv(float_format="%.3g"), encoding="utf-8")


if __name__ == "__main__":
    main()
