r"""Further twins of a cause, spread over all that was run without it, of all strengths.

    python -m benchmarks.causes.twins OUT.csv.gz --study cases/challenge/one_material.toml \
        --cause restitution_slope --experiment plate_impact --count 72 --folder /tmp/twins \
        --of cases/challenge/runs/one_material.csv.gz

Strengths are spread evenly on a logarithmic scale, from a twelfth of the largest that twins of a
diagnosis have: small ones tell how an answer begins. Started again, it goes on where it was.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from benchmarks.causes.made import make_table, words_of
from calibrate.causes.studies.from_study import with_effects
from calibrate.causes.studies.twins import GOLDEN, REACH, spread_over
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.stored import tabled_runs
from calibrate.study.data import load_data
from liggghts_io import CaseSpec
from liggghts_io.effects import Effect
from liggghts_io.materials import kind_of

LEAST = 1.0 / 12.0
"""Smallest strength, as a part of the largest."""


def cases(
    study: Path, tables: list[Path], cause: str, experiment: str, count: int
) -> list[CaseSpec]:
    """Return twins that are in no table yet, so many on every kind of wall.

    Runs that have no twin come first, then others once more with another strength.
    """
    data = load_data(study)
    effect = data.study.layout.effects[cause]
    runs = tabled_runs(data, forms_of(with_effects(data)), *tables)
    good = (runs.table["status"] == "ok").to_numpy()
    here = [
        spec
        for spec, ok in zip(runs.specs, good, strict=True)
        if ok and spec.experiment == experiment
    ]
    known = {(spec.surface, spec.seed) for spec in here if spec.effects.get(cause)}
    plain = [spec for spec in here if not any(spec.effects.values())]
    found = []
    for surface in sorted({spec.surface for spec in plain}):
        if not effect.acts_on(kind_of(surface)):
            continue
        mine = [spec for spec in plain if spec.surface == surface]
        free = [spec for spec in mine if (surface, spec.seed) not in known]
        chosen = [free[i] for i in spread_over(len(free), 0, count)]
        taken = [spec for spec in mine if spec not in free]
        chosen += [taken[i] for i in spread_over(len(taken), 0, count - len(chosen))]
        found += [
            replace(one, effects={**one.effects, cause: _strength(effect, k)})
            for k, one in enumerate(chosen)
        ]
    return found


def _strength(effect: Effect, k: int) -> float:
    """Return one of many strengths; both signs take turns where both are possible."""
    largest = REACH * effect.scale
    ends = [one for one in (min(largest, effect.high), max(-largest, effect.low)) if one]
    return float(f"{ends[k % len(ends)] * LEAST ** (k * GOLDEN % 1.0):.5g}")


def main() -> None:
    """Run them, and write the table."""
    words = words_of(__doc__)
    words.add_argument("--study", type=Path, required=True)
    words.add_argument("--cause", nargs="+", required=True)
    words.add_argument("--experiment", nargs="+", required=True)
    words.add_argument("--count", type=int, default=24, help="on every kind of wall")
    asked = words.parse_args()
    specs = [
        spec
        for cause in asked.cause
        for experiment in asked.experiment
        for spec in cases(asked.study, asked.of, cause, experiment, asked.count)
    ]
    make_table(specs, asked, "python -m benchmarks.causes.twins")


if __name__ == "__main__":
    main()
