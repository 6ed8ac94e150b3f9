"""Keep the runs of a diagnosis of `cases/oblique_impact` as a small table, and read it again.

bulkcal calibrate cases/oblique_impact/study.toml --out oblique
bulkcal diagnose cases/oblique_impact/study.toml --out oblique
python -m tests.calibrate.causes.oblique.runs oblique tests/data/causes/oblique_runs.csv.gz
"""

from __future__ import annotations

import gzip
import io
import json
import sys
from dataclasses import replace
from pathlib import Path

import pandas as pd

from calibrate.causes.studies.from_study import with_effects
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.runs import Runs
from calibrate.questions.core.stored import runs_named
from calibrate.runs.stored import DIAGNOSIS, RUNS, stored_case
from calibrate.study.cases import case_spec
from calibrate.study.data import StudyData, load_data
from tests.paths import ROOT

STUDY = ROOT / "cases" / "oblique_impact" / "study.toml"
FREE = ("mu_pw", "e_pw")


def write_runs(folder: Path, path: Path) -> None:
    """Write the runs of a diagnosis and about which strengths it learnt.

    Parameters
    ----------
    folder : Path
        Of the diagnosis.
    path : Path
        Ends in ``.csv.gz``.
    """
    record = json.loads((folder / DIAGNOSIS).read_text(encoding="utf-8"))
    forms = forms_of(with_effects(load_data(STUDY)))
    runs = runs_named(record["runs"], forms, folder / RUNS, stored_case)
    assert runs is not None, f"{folder}: not all runs of the diagnosis are there"
    rows = []
    for spec, (_, row) in zip(runs.specs, runs.table.iterrows(), strict=True):
        effect, strength = next(((k, x) for k, x in spec.effects.items() if x), ("", 0.0))
        inputs = {name: spec.parameters[name] for name in FREE}
        curves = {str(name): row[name] for name in row.index if "@" in str(name)}
        rows.append({"seed": spec.seed, **inputs, "effect": effect, "x": strength, **curves})
    text = pd.DataFrame(rows).to_csv(index=False, float_format="%.10g")
    path.write_bytes(gzip.compress(text.encode("utf-8"), mtime=0))


def read_runs(data: StudyData, path: Path) -> Runs:
    """Return the runs of a table."""
    text = gzip.decompress(path.read_bytes()).decode("utf-8")
    table = pd.read_csv(io.StringIO(text), keep_default_na=False)
    specs = []
    for seed, mu, e, effect, x in table[["seed", *FREE, "effect", "x"]].itertuples(index=False):
        (place,) = data.study.places
        values = {
            (name, data.study.layout.instance(name, place) or ""): float(value)
            for name, value in zip(FREE, (mu, e), strict=True)
        }
        spec = case_spec(data.study, place, values, int(seed))
        specs.append(replace(spec, effects={effect: float(x)} if effect else {}))
    names = [str(number) for number in range(len(table))]
    kept = table.drop(columns=["seed", *FREE, "effect", "x"])
    return Runs(tuple(specs), kept.assign(status="ok", wall_s=0.1, case_id=names))


if __name__ == "__main__":
    write_runs(Path(sys.argv[1]), Path(sys.argv[2]))
