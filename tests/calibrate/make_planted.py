"""Make the planted-parameter data: measurements by the engine at known parameters, and all runs.

    python -m tests.calibrate.make_planted WORKDIR [WORKERS]

writes `tests/calibrate/planted/measured.csv` (means and standard errors over seeds that no stage
uses) and `runs.csv` (every run that the calibration asked for). `test_planted.py` repeats the
calibration from these files and simulates two of the runs again. Takes some minutes on two cores;
interrupted and started again it goes on where it was.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pandas as pd

from calibrate.runs.campaign import Campaign
from calibrate.runs.stored import stored_case
from calibrate.staged.calibration import calibrate
from calibrate.study.cases import case_spec
from calibrate.study.data import load_data
from calibrate.study.load import load_study
from liggghts_io import execute
from liggghts_io.materials import CONTACT_PARAMETERS

HERE = Path(__file__).parent / "planted"
TRUTH = {
    "mu_pp": 0.5,
    "mu_roll_pp": 0.2,
    "mu_pw": 0.3,
    "mu_roll_pw": 0.25,
    "e_pp": 0.7,
    "e_pw": 0.45,
}
DATA_SEED, DATA_RUNS = 500_000, 5  # seeds far from those of the stages and of the check
KEY = ["experiment", "surface", "seed", *CONTACT_PARAMETERS]
OBSERVABLES = ["angle_deg", "t100_s", "m1_g", "m2_g", "m3_g", "m4_g"]


def measure(study, campaign) -> pd.DataFrame:
    """Return one row per surface with mean and standard error of every observable."""
    places = study.places
    truth = {(name, one): TRUTH[name] for name in TRUTH for one in study.instances(name)}
    specs = [
        case_spec(study, place, truth, DATA_SEED + i) for place in places for i in range(DATA_RUNS)
    ]
    table = campaign(specs, "measurements")
    rows: dict[str, dict[str, object]] = {}
    for k, place in enumerate(places):  # two walls of one kind have the same runs, not one row
        row = rows.setdefault(
            place.surface, {"particle": study.materials[0].called, "surface": place.surface}
        )
        own = table.iloc[k * DATA_RUNS : (k + 1) * DATA_RUNS]
        for name in OBSERVABLES:
            values = own[name].dropna().to_numpy()
            if len(values):
                row[name] = round(float(values.mean()), 4)
                row[f"{name}_sem"] = round(float(values.std(ddof=1) / np.sqrt(len(values))), 4)
    return pd.DataFrame(rows.values())


def main(work: Path, workers: int) -> None:
    study_path = HERE / "study.toml"
    note = (
        f"# Made by make_planted.py with the bundled engine at {TRUTH}, {DATA_RUNS} seeds each.\n"
    )
    (HERE / "measured.csv").touch()
    with Campaign(work / "runs", execute, stored=stored_case, workers=workers) as campaign:
        table = measure(load_study(study_path), campaign)
        (HERE / "measured.csv").write_text(note + table.to_csv(index=False))
        result = calibrate(load_data(study_path), campaign)
    runs = result.runs[[*KEY, "status", "reason", *OBSERVABLES]].drop_duplicates(KEY)
    (HERE / "runs.csv").write_text(note + runs.to_csv(index=False, float_format="%.10g"))


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 0)
