"""How far log evidences differ from search to search, on the rig of formulas.

    python benchmarks/causes/repeats.py --searches 6

The rig is tests/calibrate/causes/planted.py. Same data, same emulators; only the seed of the search
differs. One row per study and hypothesis: range and standard deviation of its log evidence ratio to
the base model, and the standard error that the searches state (root mean square).
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np
import pandas as pd

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from calibrate.causes.weighing.weigh_all import weigh_all
from tests.calibrate.causes.planted import study

STUDIES: tuple[dict[str, float], ...] = ({}, {"tilt": 3.0}, {"cohesion": 4.0})


def repeats(hidden: dict[str, float], searches: int) -> pd.DataFrame:
    """Return a row per cause of one study."""
    board = study(hidden, np.random.default_rng(1))
    found = [weigh_all(board, np.random.default_rng([2, seed])) for seed in range(searches)]
    rows = []
    for one in board.candidates:
        names = (one.name,)
        ratio = np.array([f.weighed[names].log_evidence - f.base.log_evidence for f in found])
        error = np.array([np.hypot(f.weighed[names].error, f.base.error) for f in found])
        rows.append(
            {
                "hidden": " ".join(hidden) or "nothing",
                "cause": one.name,
                "log_ratio": ratio.mean(),
                "range": np.ptp(ratio),
                "sd": ratio.std(ddof=1),
                "stated": np.sqrt(np.mean(error**2)),
            }
        )
    return pd.DataFrame(rows)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--searches", type=int, default=6)
    asked = parser.parse_args()
    table = pd.concat([repeats(hidden, asked.searches) for hidden in STUDIES])
    print(table.to_string(index=False, float_format=lambda x: f"{x:.3f}"))


if __name__ == "__main__":
    main()
