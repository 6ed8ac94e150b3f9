"""Diagnose engine data whose material, strengths and seeds were drawn, and say how it went.

    python benchmarks/diagnosis_blind.py tests/data/diagnose/blind.csv

Every study hides nothing, one cause of the library, or an error outside it. Measurement errors
are drawn several times per study. The fitter has the recorded runs of `diagnosis_runs.py`: two
local designs around points chosen long before these data were made.
"""

from __future__ import annotations

import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np
import pandas as pd

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from calibrate.diagnose import diagnose
from tests.calibrate.diagnose import engine as recorded

ERRORS = (1, 2, 3)


def study(name: str, seed: int) -> dict[str, object]:
    """Diagnose one study with one draw of the measurement errors."""
    hidden = recorded.every_case()[name]
    runs = recorded.read_runs()
    with tempfile.TemporaryDirectory() as directory:
        problem = recorded.problem(Path(directory), runs, hidden, seed)
        rng = np.random.default_rng(seed)
        found = diagnose(problem, recorded.Recorded(runs), rng=rng, options=recorded.OPTIONS)
    verdict = found.verdict
    truth = next(iter(hidden.effects), "")
    row: dict[str, object] = {
        "study": name,
        "errors": seed,
        "strength": hidden.effects.get(truth, 0.0),
        "kind": verdict.kind,
        "names": "+".join(verdict.names),
        "p_misfit": verdict.p_misfit,
        "p_search": verdict.p_search,
    }
    if truth in verdict.intervals:
        low, high = verdict.intervals[truth].interval95
        row |= {"low95": low, "high95": high}
        row["fitted"] = next(s.strength for s in verdict.suspects if s.candidate == truth)
    if truth:
        row["detectable"] = found.absorption.of(truth).detectable
    return row


def main(path: Path) -> None:
    """Diagnose all studies and write the table."""
    names = recorded.every_case()
    jobs = [(name, seed) for name in names for seed in ERRORS]
    with ProcessPoolExecutor(2) as pool:
        rows = list(pool.map(study, *zip(*jobs, strict=True)))
    table = pd.DataFrame(rows)
    with path.open("w", encoding="utf-8") as file:
        file.write(f"# python benchmarks/diagnosis_blind.py {path}\n")
        table.to_csv(file, index=False, float_format="%.5g")
    print(table.to_string(float_format="%.4g"))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
