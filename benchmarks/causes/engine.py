"""What the diagnosis says on recorded engine runs of HSP13.

    python benchmarks/causes/engine.py paper    the paper's eight numbers
    python benchmarks/causes/engine.py halves   the same, from each half of the runs
    python benchmarks/causes/engine.py planted OUT.csv     hidden effects, runs as data
    python benchmarks/causes/engine.py nested  evidences by nested sampling, here and on a rig of
                                               formulas (an hour)

Emulators are trained on the runs recorded in tests/data/emulator. A hidden effect is a recorded
run with that effect on: the emulators do not see the runs of its point, though their
hyperparameters do. Points are taken from the middle of the ranges outwards.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from calibrate.causes.diagnosis import Options, diagnose
from calibrate.causes.hypotheses import Board, weigh_hypothesis
from calibrate.causes.verdict import Levels
from calibrate.causes.words import sentences
from calibrate.inference.sampling import sample
from tests.calibrate.causes.engine import (
    ERRORS,
    Bench,
    benches,
    board_of,
    candidates_of,
    conditioned,
    paper_readings,
    paper_scales,
    readings_of,
)
from tests.calibrate.causes.planted import study
from tests.calibrate.emulator.recorded import PLACES, read_runs

SEED = 3
HIDDEN = ("", "plate_tilt_deg", "plate_period", "mass_flow_factor", "cohesion_J_m3",
          "size_distribution")  # fmt: skip


def told(what: str, share: float) -> None:
    """Print what is done next."""
    print(f"{100 * share:3.0f} % {what}", file=sys.stderr, flush=True)


def paper() -> None:
    """Print the diagnosis of the paper's data."""
    found = benches()
    board = board_of(found, paper_readings(), candidates_of(found))
    start = time.process_time()
    result = diagnose(board, np.random.default_rng(SEED), scales=paper_scales(), progress=told)
    print("\n".join(sentences(result)))
    print(result.table().drop(columns="alike").to_string(float_format="%.3g"))
    print(result.residual_table().to_string(float_format="%.3g"))
    print(result.verdict)
    names = result.base.problem.space.names
    print(dict(zip(names, result.base.best.round(3), strict=True)))
    print(f"{time.process_time() - start:.0f} s of processor time")


def ratios(board: Board) -> pd.Series:
    """Return the log evidence ratio of every candidate."""
    base = weigh_hypothesis(board.hypothesis(), SEED)
    return pd.Series(
        {
            one.name: weigh_hypothesis(board.hypothesis(one.name), SEED, base).log_evidence
            - base.log_evidence
            for one in board.candidates
        }
    )


def halves() -> None:
    """Print log evidence ratios from emulators of disjoint halves of the runs."""
    table = {}
    for half in (0, 1):
        keep = {name: read_runs(name).points % 2 == half for name in PLACES}
        found = benches(keep)
        board = board_of(found, paper_readings(), candidates_of(found))
        table[f"half {half + 1}"] = ratios(board)
        print(table[f"half {half + 1}"].to_string(float_format="%.2f"), flush=True)
    both = pd.DataFrame(table)
    both["difference"] = both["half 1"] - both["half 2"]
    print(both.to_string(float_format="%.2f"))


def nested() -> None:
    """Print log evidences with their errors, by importance and by nested sampling (dynesty)."""
    found = benches()
    recorded = board_of(found, paper_readings(), candidates_of(found))
    formulas = study({"tilt": 3.0}, np.random.default_rng([11, 0]))
    for board, what in ((formulas, "tilt"), (recorded, "plate_tilt_deg")):
        base = weigh_hypothesis(board.hypothesis(), SEED)
        named = weigh_hypothesis(board.hypothesis(what), SEED, base)
        for one in (base, named):
            start = time.process_time()
            again = sample(one.problem, np.random.default_rng(SEED), method="nested")
            print(
                f"{' '.join(one.hypothesis.names) or 'base model'}: {one.log_evidence:.3f} +- "
                f"{one.error:.3f}; nested {again.log_evidence:.3f} +- "
                f"{again.log_evidence_error:.3f}, {time.process_time() - start:.0f} s",
                flush=True,
            )


def hidden_points(effect: str) -> list[int]:
    """Return points that have a run in every place, with the effect on where it acts."""
    found: set[int] | None = None
    for name in PLACES:
        runs = read_runs(name)
        on = runs.inputs.strengths != 0.0
        acts = effect in runs.effects
        rows = on[:, runs.effects.index(effect)] if acts else ~on.any(axis=1)
        here = {int(p) for p, y in zip(runs.points[rows], runs.y[rows], strict=True)
                if np.isfinite(y).all()}  # fmt: skip
        found = here if found is None else found & here
    whole = read_runs("heap steel")
    at = dict(zip(whole.points.tolist(), whole.inputs.u, strict=True))
    return sorted(found or (), key=lambda p: float(np.abs(at[p] - 0.5).max()))


def one_planted(
    whole: Mapping[str, Bench], effect: str, point: int, studies: int
) -> dict[str, object]:
    """Diagnose a recorded run with errors of measurement added; its point is left out."""
    rng = np.random.default_rng([SEED, point])
    found, values, strength = {}, {}, 0.0
    for name, bench in whole.items():
        runs = bench.runs
        found[name] = conditioned(bench, runs.points != point)
        on = runs.inputs.strengths
        acts = effect in runs.effects
        row = on[:, runs.effects.index(effect)] != 0.0 if acts else ~on.any(axis=1)
        at = int(np.flatnonzero(row & (runs.points == point))[0])
        strength = float(on[at, runs.effects.index(effect)]) if acts else strength
        luck = rng.standard_normal(1 if name.startswith("conveyor") else runs.y.shape[1])
        values[name] = runs.y[at] + ERRORS[name] * luck
    readings = readings_of(
        values, curves=True, noise={n: b.emulator.noise for n, b in found.items()}
    )
    board = board_of(found, readings, candidates_of(found))
    options = Options(Levels(studies=studies), held_out=False)
    result = diagnose(board, np.random.default_rng(SEED), options=options, progress=told)
    verdict = result.verdict
    mine = [result.log_ratio(c.name) for c in board.candidates if c.effect == effect]
    share = sum(p for name, p in verdict.probabilities.items()
                if name.partition(":")[0] == (effect or "none"))  # fmt: skip
    return {
        "hidden": effect or "nothing",
        "point": point,
        "strength": strength,
        "studies": studies,
        "kind": verdict.kind,
        "names": " ".join(verdict.names),
        "probability": round(share, 3),
        "in_set": any(n.partition(":")[0] == (effect or "none") for n in verdict.credible),
        "log_ratio": round(max(mine, default=0.0), 2),
        "best_log_ratio": round(max(result.log_ratio(c.name) for c in board.candidates), 2),
        "p_best": round(verdict.chances.p_best, 3),
        "p_misfit": round(verdict.chances.p_misfit, 3),
    }


def planted(out: Path, points: int, studies: int) -> None:
    """Write a row per hidden effect and point."""
    rows, whole = [], benches()
    order = [(k, effect) for k in range(points) for effect in HIDDEN]
    for k, effect in order:
        for point in hidden_points(effect)[k : k + 1]:
            rows.append(one_planted(whole, effect, point, studies))
            print(rows[-1], flush=True)
            head = (
                f"# python benchmarks/causes/engine.py planted {out.name} --points {points} "
                f"--studies {studies}\n"
            )
            out.write_text(head + pd.DataFrame(rows).to_csv(index=False), encoding="utf-8")


def main() -> None:
    """Do what the command line says."""
    parser = argparse.ArgumentParser()
    parser.add_argument("what", choices=("paper", "halves", "planted", "nested"))
    parser.add_argument("out", type=Path, nargs="?")
    parser.add_argument("--points", type=int, default=3)
    parser.add_argument("--studies", type=int, default=100, help="imagined ones, of each verdict")
    asked = parser.parse_args()
    if asked.what == "planted":
        planted(asked.out, asked.points, asked.studies)
    else:
        {"paper": paper, "halves": halves, "nested": nested}[asked.what]()


if __name__ == "__main__":
    main()
