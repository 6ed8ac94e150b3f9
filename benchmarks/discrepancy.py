"""What a chance of model discrepancy does to the joint posterior of runs that are there.

    python benchmarks/discrepancy.py cases/proppants/hsp13_steel.toml demo [--chances 0 0.02 0.05]

Trains emulators on all finished runs of a calibration's directory and prints the 90 % intervals
and, for each target, how probable it is that the simulation misses it whatever its parameters are.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np
import pandas as pd
from threadpoolctl import threadpool_limits

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from calibrate.inference.discrepancy import discrepancy_probabilities, with_discrepancy
from calibrate.inference.sampling import sample
from calibrate.questions.core.emulate import emulators_of
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.problem import problem_of
from calibrate.questions.core.stored import stored_runs
from calibrate.study.data import load_data


def main() -> None:
    """Print the posterior for every chance."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("study", type=Path)
    parser.add_argument("directory", type=Path)
    parser.add_argument("--chances", type=float, nargs="+", default=[0.0, 0.02, 0.05])
    args = parser.parse_args()
    data = load_data(args.study)
    forms = forms_of(data)
    runs = stored_runs(data, forms, args.directory / "runs")
    if runs is None:
        sys.exit(f"{args.directory}: no runs of this study")
    spans, odds = {}, {}
    with threadpool_limits(1):
        emulators = emulators_of(forms, runs)
        trained = {key: one.emulator for key, one in emulators.trained.items()}
        plain = problem_of(data, forms, trained)
        for chance in args.chances:
            problem = with_discrepancy(plain, chance, np.random.default_rng(1))
            posterior = sample(problem, np.random.default_rng(2))
            ends = np.quantile(posterior.samples, [0.05, 0.95], axis=0).T
            spans[chance] = {
                name: f"{low:.3g} to {high:.3g}"
                for name, (low, high) in zip(posterior.names, ends, strict=True)
            }
            odds[chance] = {
                reading.name: round(float(one), 2)
                for place in problem.places
                for reading, one in zip(
                    place.readings,
                    discrepancy_probabilities(place, posterior.samples).mean(axis=0),
                    strict=True,
                )
            }
    print(f"{len(runs)} runs; 90 % intervals by the chance of a discrepancy")
    print(pd.DataFrame(spans).to_string())
    print("probability of a discrepancy after the data")
    print(pd.DataFrame(odds).to_string())


if __name__ == "__main__":
    main()
