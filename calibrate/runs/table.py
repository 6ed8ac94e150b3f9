"""Runs as a table to keep and to hand on: inputs, seeds, numbers and digests, without any output.

A megabyte of it stands for gigabytes of case directories: whoever has the table fits anew in
seconds, and whoever doubts a row runs it again.
"""

from __future__ import annotations

import csv
import gzip
import io
import json
import re
import zlib
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
import pandas as pd

from calibrate.errors import CalibrationError
from liggghts_io import (
    CaseError,
    CaseResult,
    CaseSpec,
    OwnExperiment,
    experiment_of,
    is_final,
    load_result,
    load_spec,
    read_curve,
)
from liggghts_io.case.directory import load_record
from liggghts_io.files import canonical_json, sha256_text, shell_word, write_bytes
from liggghts_io.materials import particle_of, plain_particle
from liggghts_io.measure.dumps import SCRIPT
from liggghts_io.measure.schedule import load_of

__all__ = ["TableRow", "digest_of", "finished_rows", "is_table", "read_rows", "write_rows"]

DIGITS: Final = 16
"""Of a digest: enough to tell rows apart, and short."""
OWN: Final = "own"
"""Column with the digest of the folder of an experiment of somebody's own, if there is one."""
PLAIN: Final = ("experiment", "surface", "scale", "engine", "seed")
"""Fields of a spec that are columns of the same name."""
MAPPINGS: Final = ("parameters", "apparatus", "effects")
"""Fields of a spec with a column per entry, ``FIELD.NAME``."""
SEEN: Final = "observables"
CURVES: Final = "curves"
"""Column per curve and level, ``curves.NAME@LEVEL``, at the levels of the experiment."""
SECONDS: Final = 2
"""Decimals of a duration."""
NOTE: Final = re.compile(r"; (\d+) runs, sha256 ([0-9a-f]{16})$")
"""How the comment on top ends: what is below it. Tables of earlier versions do not say it."""


class TableRow(NamedTuple):
    """One run.

    Attributes
    ----------
    spec : CaseSpec
        All that it needs to be run again.
    result : CaseResult
        Its numbers; without a path, since no directory belongs to it.
    facts : mapping
        ``engine_code`` and ``observables_code`` that made it, ``script`` and ``digest``: those of
        its script and of what was measured; ``steps`` and ``grains``: its size.
    curves : mapping
        ``NAME@LEVEL`` to the value of a curve there; what was not reached is left out.
    """

    spec: CaseSpec
    result: CaseResult
    facts: Mapping[str, Any]
    curves: Mapping[str, float] = {}


def digest_of(result: CaseResult) -> str:
    """Return the digest of what a run gave: its observables and its curves."""
    plain = {SEEN: dict(result.observables), "tables": dict(result.tables)}
    return sha256_text(canonical_json(plain))[:DIGITS]


def finished_rows(root: Path) -> list[TableRow]:
    """Return the finished runs under a directory, in the order of their names.

    Parameters
    ----------
    root : Path
        Directory of case directories. What is under way, damaged or of another version is left
        out.
    """
    found = []
    for directory in sorted(root.iterdir()):
        try:
            spec, result = load_spec(directory), load_result(directory)
            inputs = load_record(directory)["inputs"]
        except (CaseError, OSError):
            continue
        if is_final(result):
            facts = _facts(directory, inputs, result)
            found.append(TableRow(spec, result, facts, _curves(spec, result)))
    return found


def _curves(spec: CaseSpec, result: CaseResult) -> dict[str, float]:
    """Return the curves of a run at the levels of its experiment."""
    found: dict[str, float] = {}
    for curve in experiment_of(spec).curves if result.status == "ok" else ():
        values = read_curve(result, curve)
        found |= {
            f"{curve.name}@{level:g}": float(value)
            for level, value in zip(curve.levels, values, strict=True)
            if np.isfinite(value)
        }
    return found


def _facts(directory: Path, inputs: Mapping[str, Any], result: CaseResult) -> dict[str, Any]:
    load = load_of((directory / SCRIPT).read_text(encoding="utf-8"))
    return {
        "engine_code": inputs["code"]["engine"],
        "observables_code": inputs["code"]["observables"][:DIGITS],
        "script": inputs["script"][:DIGITS],
        "digest": digest_of(result),
        "steps": int(load.steps),
        "grains": int(load.grains),
    }


def write_rows(path: Path, rows: Iterable[TableRow], header: str) -> int:
    """Write runs as CSV, compressed where the name ends in .gz; return how many there are.

    Parameters
    ----------
    path : Path
        Replaced as a whole. The same runs give the same bytes.
    rows : iterable of TableRow
    header : str
        Comment on top: where the runs come from.
    """
    columns = [_columns(row) for row in rows]
    table = pd.DataFrame(columns)
    names = [str(name) for name in table]
    mapped = sorted(name for name in names if name.partition(".")[0] in (*MAPPINGS, SEEN, CURVES))
    first = [name for name in names if name not in mapped]
    body = table[[*first, *mapped]].to_csv(index=False)
    text = f"# {header}; {len(columns)} runs, sha256 {_body_digest(body)}\n{body}"
    content = text.encode("utf-8")
    write_bytes(path, gzip.compress(content, mtime=0) if path.suffix == ".gz" else content)
    return len(columns)


def _body_digest(body: str) -> str:
    """Return the digest of what stands below the comment, whatever ends its lines."""
    return sha256_text(body.replace("\r\n", "\n"))[:DIGITS]


def _columns(row: TableRow) -> dict[str, Any]:
    spec, result = row.spec, row.result
    parts = {name: getattr(spec, name) for name in MAPPINGS}
    parts |= {SEEN: result.observables, CURVES: row.curves}
    return {
        "case_id": result.case_id,
        **{name: getattr(spec, name) for name in PLAIN},
        "particle": canonical_json(plain_particle(spec.particle)),
        **row.facts,
        "status": result.status,
        "failure": str(result.failure),
        "reason": result.reason,
        "wall_s": round(result.wall_s, SECONDS),
        **{f"{part}.{name}": value for part, all_ in parts.items() for name, value in all_.items()},
        **({} if spec.own is None else {OWN: spec.own.digest[:DIGITS]}),
    }


def is_table(path: Path) -> bool:
    """Whether a file begins as a table of runs does, so that a newer one may replace it."""
    try:
        with gzip.open(path) if path.suffix == ".gz" else path.open("rb") as opened:
            comment, head = opened.readline(), opened.readline()
    except (OSError, EOFError, zlib.error):
        return False
    return comment.startswith(b"#") and head.startswith(b"case_id,")


def read_rows(path: Path, own: Iterable[OwnExperiment] = ()) -> list[TableRow]:
    """Read a table of runs.

    Parameters
    ----------
    path : Path
    own : iterable of OwnExperiment, optional
        Experiments of somebody's own whose runs may be in it; a table does not hold their folders,
        and runs of other folders, or of other contents of these, are left out.

    Raises
    ------
    CalibrationError
        For a file that is none, and for one that was cut or changed, with the command that writes
        one.
    """
    try:
        body = _whole_body(path)
        table = pd.read_csv(io.StringIO(body), dtype=str, keep_default_na=False)
        records = [{str(name): one[name] for name in one} for one in table.to_dict("records")]
        folders = {"": None, **{one.digest[:DIGITS]: one for one in own}}
        return [
            _row(one, folders[one.get(OWN, "")]) for one in records if one.get(OWN, "") in folders
        ]
    except (OSError, ValueError, KeyError, TypeError, EOFError, zlib.error) as err:
        why = f"no column {err}" if isinstance(err, KeyError) else getattr(err, "strerror", "")
        msg = (
            f"{path}: no table of runs ({why or err}); 'bulkcal runs DIR {shell_word(path.name)}' "
            "writes one of the runs in a directory"
        )
        raise CalibrationError(msg) from err


def _whole_body(path: Path) -> str:
    """Return what stands below the comment of a table, when nothing of it is missing.

    Raises
    ------
    OSError, ValueError, EOFError, zlib.error
        The last two for a compressed table that is no such file, or was cut.
    """
    raw = path.read_bytes()
    text = (gzip.decompress(raw) if path.suffix == ".gz" else raw).decode("utf-8")
    head, _, body = text.partition("\n")
    noted = NOTE.search(head.rstrip())
    if noted is not None and noted[2] != _body_digest(body):
        msg = (
            f"was cut or changed since its {noted[1]} runs were written; where the change is "
            f"meant, delete '{noted[0]}' at the end of its first line"
        )
        raise ValueError(msg)
    if not body.endswith("\n"):
        msg = "its last line has no end, so that it was cut"
        raise ValueError(msg)
    names, *rows = csv.reader(io.StringIO(body))
    for number, row in enumerate(rows, 1):
        if row and len(row) != len(names):
            msg = f"run {number} has {len(row)} cells under {len(names)} names of columns"
            raise ValueError(msg)
    return body


def _row(cells: dict[str, str], own: OwnExperiment | None) -> TableRow:
    parts: dict[str, dict[str, float]] = {name: {} for name in (*MAPPINGS, SEEN, CURVES)}
    for name, cell in cells.items():
        part, _, bare = name.partition(".")
        if part in parts and cell:
            parts[part][bare] = float(cell)
    spec = CaseSpec(
        experiment=cells["experiment"],
        particle=particle_of(json.loads(cells["particle"])),
        surface=cells["surface"],
        scale=cells["scale"],
        parameters=parts["parameters"],
        apparatus=parts["apparatus"],
        effects=parts["effects"],
        seed=int(cells["seed"]),
        engine=cells["engine"],
        own=own,
    )
    result = CaseResult(
        case_id=cells["case_id"], path=Path(), status=cells["status"], reason=cells["reason"],
        observables=parts[SEEN], wall_s=float(cells["wall_s"]), failure=cells["failure"],
    )  # fmt: skip
    words = ("engine_code", "observables_code", "script", "digest")
    facts: dict[str, Any] = {name: cells[name] for name in words}
    facts |= {name: int(cells[name]) for name in ("steps", "grains")}
    return TableRow(spec, result, facts, parts[CURVES])
