"""Error rates, power and coverage of the diagnosis on a fast stand-in for the engine.

    python benchmarks/diagnosis_statistics.py tests/data/diagnose/statistics.csv

Every row is one imagined study: parameters off the staged result, five repeats, errors estimated
from them, its own runs with their own seeds. Prints a summary with Clopper-Pearson intervals.
"""

from __future__ import annotations

import sys
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict
from pathlib import Path

import pandas as pd
from scipy.stats import beta

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from tests.calibrate.diagnose import cases

NULLS, EACH = 200, 12
FACTORS = (1.0, 2.0, 4.0)


def clopper_pearson(hits: int, total: int) -> tuple[float, float]:
    """95 % interval of a rate."""
    low = beta.ppf(0.025, hits, total - hits + 1) if hits else 0.0
    high = beta.ppf(0.975, hits + 1, total - hits) if hits < total else 1.0
    return float(low), float(high)


def line(label: str, hits: int, total: int) -> None:
    """Print a rate with its interval."""
    low, high = clopper_pearson(hits, total)
    print(f"{label:58s} {hits:4d}/{total:<4d} {hits / total:6.3f}  [{low:.3f}, {high:.3f}]")


def one(job: tuple[str, str, float, int]) -> tuple[str, float, cases.Outcome]:
    """Diagnose one imagined study."""
    what, name, factor, seed = job
    if what == "nothing":
        return what, factor, cases.nothing(seed)
    if what == "foreign":
        return what, factor, cases.foreign(seed, 0.08)
    return what, factor, cases.planted(seed, name, cases.strength_at(name, factor))


def main(path: Path) -> None:
    """Run all cases and write the table."""
    limits = cases.limits(range(5))
    print("detectable:", {k: round(v, 3) for k, v in limits.items()}, flush=True)
    jobs = [("nothing", "", 0.0, 10_000 + k) for k in range(NULLS)]
    jobs += [
        ("planted", name, factor, 20_000 + k)
        for name in cases.DETECTABLE
        for factor in FACTORS
        for k in range(EACH)
    ]
    jobs += [("foreign", "", 0.0, 30_000 + k) for k in range(EACH)]
    with ProcessPoolExecutor(2) as pool:
        rows = list(pool.map(one, jobs))
    table = pd.DataFrame([{"what": w, "factor": f, **asdict(o)} for w, f, o in rows])
    with path.open("w", encoding="utf-8") as file:
        file.write("# python benchmarks/diagnosis_statistics.py " + str(path) + "\n")
        table.to_csv(file, index=False, float_format="%.5g")
    summary(rows)


def summary(rows: list[tuple[str, float, cases.Outcome]]) -> None:
    """Print all rates."""
    nulls = [o for w, _, o in rows if w == "nothing"]
    for kind in ("named", "group", "unknown"):
        line(f"nothing hidden: {kind}", sum(o.kind == kind for o in nulls), len(nulls))
    for name in cases.DETECTABLE:
        for factor in FACTORS:
            some = [o for w, f, o in rows if w == "planted" and f == factor and o.hidden == name]
            label = f"{name} at {factor:g} x detectable"
            line(
                label + ": named", sum(o.kind == "named" and not o.named_wrong for o in some), EACH
            )
            line(label + ": named or in group", sum(o.contains_truth for o in some), EACH)
            line(label + ": named wrongly", sum(o.named_wrong for o in some), EACH)
    sized = [o for w, f, o in rows if w == "planted" and f >= 2.0 and o.contains_truth]
    line(
        "strength inside its 95 % interval, 2 x and 4 x", sum(o.covered for o in sized), len(sized)
    )
    away = [o for w, _, o in rows if w == "foreign"]
    line("period 8 % too long, not in library: named", sum(o.kind == "named" for o in away), EACH)
    line("period 8 % too long: unknown", sum(o.kind == "unknown" for o in away), EACH)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
