"""Runs that are stored already and are points of a study's space, whoever asked for them."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.errors import CalibrationError
from calibrate.questions.core.design import Stand, case_at, stands_of
from calibrate.questions.core.forms import Form, FormKey
from calibrate.questions.core.runs import Runs, with_curves
from calibrate.runs.campaign import run_table
from calibrate.runs.table import TableRow, read_rows
from calibrate.study.data import StudyData
from calibrate.study.model import Study
from liggghts_io import CaseError, CaseResult, CaseSpec, case_id, load_spec, stored_result
from liggghts_io.case.spec import setup_of
from liggghts_io.materials import Particle, kind_of

__all__ = ["question", "runs_named", "runs_of_rows", "stored_runs", "tabled_runs"]

ALIKE: Final = 1e-6
"""Difference below which two contact parameters are the same."""


def stored_runs(
    data: StudyData,
    forms: Mapping[FormKey, Form],
    root: Path,
    named: Collection[str] | None = None,
) -> Runs | None:
    """Return the finished runs under a directory that a study can learn from.

    These are runs of the same experiments, grains, scale, engine, code and fixed values, at any
    values of what is free: those of stages, of an earlier budget or of a diagnosis.

    Parameters
    ----------
    data : StudyData
    forms : mapping
        Form by key.
    root : Path
        Directory of case directories; need not exist.
    named : collection of str, optional
        Cases to look at; all where it is left out.

    Returns
    -------
    Runs or None
        None where there are none. In the order of what they ask: that of their names would be
        another one for every version of the code, and sums end in the order of their parts.
    """
    stands = stands_of(data.study, forms)
    found: list[tuple[CaseSpec, CaseResult]] = []
    for directory in sorted(root.iterdir()) if root.is_dir() else ():
        if named is not None and directory.name not in named:
            continue
        try:
            spec = load_spec(directory)
            # A case of other code or of another version has another name today.
            today = any(_fits(data.study, s, spec) for s in stands) and case_id(spec)
        except (CaseError, OSError):
            continue  # no case, or one of another version
        result = stored_result(root, directory.name) if today == directory.name else None
        if result is not None:
            found.append((spec, result))
    found.sort(key=lambda one: question(one[0]))
    specs, results = [one for one, _ in found], [one for _, one in found]
    return with_curves(specs, run_table(specs, results), forms) if specs else None


def runs_named(
    names: Sequence[str],
    forms: Mapping[FormKey, Form],
    root: Path,
    stored: Callable[[CaseSpec, Path], CaseResult | None],
) -> Runs | None:
    """Return finished runs by name, in that order.

    Parameters
    ----------
    names : sequence of str
        Case ids.
    forms : mapping
        Form by key.
    root : Path
        Directory of case directories.
    stored : callable
        Reads the stored result of a case under a root.

    Returns
    -------
    Runs or None
        None where one of them is gone, not finished, or of other code.
    """
    specs: list[CaseSpec] = []
    results: list[CaseResult] = []
    for name in names:
        try:
            spec = load_spec(root / name)
            result = stored(spec, root)
        except (CaseError, OSError):
            return None
        if result is None or result.case_id != name:
            return None
        specs.append(spec)
        results.append(result)
    return with_curves(specs, run_table(specs, results), forms) if specs else None


def tabled_runs(data: StudyData, forms: Mapping[FormKey, Form], *paths: Path) -> Runs:
    """Return the runs of tables that a study can learn from, whatever code made them.

    Parameters
    ----------
    data : StudyData
    forms : mapping
        Form by key.
    *paths : Path
        Tables that `calibrate.runs.table.write_rows` wrote.

    Raises
    ------
    CalibrationError
        For a file that is no such table, and where none of their runs is of this study.
    """
    own, stands = data.study.own, stands_of(data.study, forms)
    rows = [row for one in paths for row in read_rows(one, own.values())]
    # Two versions of the code may have made one run each of the same case; it counts once.
    once = {question(row.spec): row for row in rows}.values()
    fitting = [row for row in once if any(_fits(data.study, one, row.spec) for one in stands)]
    if not fitting:
        names = " and ".join(map(str, paths))
        folders = f", the folder of {' and '.join(own)} unchanged" if own else ""
        msg = (
            f"{names}: none of the {len(rows)} runs is one of {data.path.name}: same experiments, "
            f"grains, scale, engine and fixed values, and what is free within its range{folders}"
        )
        raise CalibrationError(msg)
    return runs_of_rows(fitting, forms)


def runs_of_rows(rows: Sequence[TableRow], forms: Mapping[FormKey, Form]) -> Runs:
    """Return rows of a table as runs, with the curves that their forms ask for.

    Parameters
    ----------
    rows : sequence of TableRow
    forms : mapping
        Form by key.
    """
    specs = [row.spec for row in rows]
    table = run_table(specs, [row.result for row in rows])
    kept = {row.result.case_id: row for row in rows}

    def read(spec: CaseSpec, path: Path, name: str, levels: Sequence[float]) -> Array:
        return _curve(kept[path.name], name, levels)

    named = table.assign(path=table["case_id"])
    return with_curves(specs, named, forms, read)


def question(spec: CaseSpec) -> str:
    """Return what a case asks, whatever its grains are called and whatever code answers."""
    parts = (spec.parameters, spec.apparatus, spec.effects)
    plain = (getattr(spec, name) for name in ("experiment", "surface", "scale", "engine", "seed"))
    numbers = (tuple(sorted(part.items())) for part in parts)
    # A record says how the sizes are; who asks may leave that to the experiment.
    grains = replace(spec.particle, name="") if spec.particle.sizes else _grains(spec)
    return repr((*plain, grains, spec.own, *numbers))


def _curve(row: TableRow, name: str, levels: Sequence[float]) -> Array:
    """Return a curve of a row, straight between the levels it was kept at; nan beyond them."""
    own = sorted(
        (float(key.partition("@")[2]), value)
        for key, value in row.curves.items()
        if key.partition("@")[0] == name
    )
    if not own:
        return np.full(len(levels), np.nan)
    x, y = np.array(own).T
    return np.asarray(np.interp(levels, x, y, left=np.nan, right=np.nan))


def _fits(study: Study, stand: Stand, spec: CaseSpec) -> bool:
    """Whether a case is one that the study could ask for, at some values of what is free."""
    if spec.experiment != stand.form.key[0]:  # most are told apart here
        return False
    try:
        grains, kind = _grains(spec), kind_of(spec.surface)
    except CaseError:
        return False  # another version could run it
    if kind != stand.form.key[1]:
        return False
    u, strengths = stand.form.place_in(spec)
    if not (np.isfinite(u).all() and np.all(np.abs(u - 0.5) <= 0.5 + ALIKE)):
        return False
    own = case_at(study, stand, u, strengths, spec.seed)
    same = all(getattr(own, name) == getattr(spec, name) for name in ("scale", "engine", "own"))
    return (
        same
        and _grains(own) == grains
        and _near(own.apparatus, spec.apparatus)
        and _near(own.effects, spec.effects)
        and all(
            abs(value - spec.parameters.get(name, np.nan)) < ALIKE
            for name, value in own.parameters.items()
        )
    )


def _grains(spec: CaseSpec) -> Particle:
    """Return the grains of a case as simulated, whatever they are called.

    A record says how the sizes are, a study may leave it to the experiment.
    """
    return replace(setup_of(spec).particle, name="")


def _near(one: Mapping[str, float], other: Mapping[str, float]) -> bool:
    """Whether two apparatus, or the strengths of effects, are the same up to rounding."""
    return one.keys() == other.keys() and all(
        np.isclose(value, other[name], rtol=ALIKE) for name, value in one.items()
    )
