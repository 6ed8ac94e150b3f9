"""Let 3000 disks run out of a hopper and watch the height of the pile, with two rolling models.

    python benchmarks/engine/ai_pile.py tests/data/ai_pile.csv

About five minutes a model. Prints the heights beside those read from Ai, Chen, Rotter and Ooi,
Powder Technology 206 (2011) 269, and stores all of them.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

import numpy as np
import pandas as pd

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from minidem import run_script
from tests.minidem.laws import pile_scripts as piles

MODELS = ("epsd2", "cdt")
SEED = 20
END = 50.0  # s
REFERENCE = pd.DataFrame(
    {
        "time_s": [9.6, 13.7, 20.6, 30.0, 40.0, 48.4],
        "epsd": [0.2720, 0.2720, 0.2720, 0.2720, 0.2723, 0.2720],
        "constant": [0.2419, 0.2310, 0.2253, 0.2222, 0.2200, 0.2192],
    }
)
"""Heights in m, read from the curves of that paper (data of Lethe's example)."""


def run_model(model: str, end: float) -> pd.Series:
    """Return the height, m, by time, s, of one run."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        words = f"hertz tangential history rolling_friction {model}"
        text = piles.hopper(words, np.random.default_rng(SEED), folder, end)
        (folder / "in.pile").write_text(text)
        run_script(folder / "in.pile", root=folder)
        table = piles.heights(folder / "log.liggghts")
    found = pd.Series(table[:, 3], index=(table[:, 0] * piles.DT).round(6), name=model)
    return found[~found.index.duplicated()]


def main() -> None:
    """Run both models, print and store the heights."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("path", type=Path, help="CSV to write")
    parser.add_argument("--models", nargs="+", default=list(MODELS), choices=MODELS)
    parser.add_argument("--end", type=float, default=END, help="simulated time, s")
    chosen = parser.parse_args()
    table = pd.DataFrame({model: run_model(model, chosen.end) for model in chosen.models})
    if chosen.path.exists():  # a model that was not run again keeps its heights
        stored = pd.read_csv(chosen.path, comment="#", index_col="time_s")
        table = table.combine_first(stored)
    with chosen.path.open("w", encoding="utf-8") as file:
        file.write("# python benchmarks/engine/ai_pile.py tests/data/ai_pile.csv\n")
        table.to_csv(file, index_label="time_s", float_format="%.6g")
    print("| time (s) | paper, EPSD | epsd2 | paper, constant torque | cdt |")
    print("|---|---|---|---|---|")
    for row in REFERENCE.itertuples():
        near = table.iloc[np.abs(table.index.to_numpy() - row.time_s).argmin()]
        ours = [near.get(model, np.nan) for model in MODELS]
        cells = (row.epsd, ours[0], row.constant, ours[1])
        print(f"| {row.time_s} | {' | '.join(f'{height:.3f}' for height in cells)} |")


if __name__ == "__main__":
    main()
