"""Write a study file of the first form anew, in the present one."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

from calibrate.errors import CalibrationError
from calibrate.study.draft import tables_in
from calibrate.study.load import read_study_file, toml_in
from calibrate.study.old_form import is_old
from calibrate.study.writing.toml import document
from liggghts_io.materials import CONTACT_PARAMETERS, GLUED, GLUED_PARAMETERS

__all__ = ["migrated_text"]

_SCALES: Final = {"none": "linear"}
_TARGET_KEYS: Final = {"sem_column": "se_column", "transform": "scale"}


def migrated_text(path: Path) -> str:
    """Return the text of a study of the first form in the present form, with equal meaning.

    Comments at the top are kept; those between the tables are not, since the tables change.

    Parameters
    ----------
    path : Path
        File of the first form.

    Raises
    ------
    CalibrationError
        When it cannot be read, or has the present form already.
    """
    text, data = toml_in(path, read_study_file(path))
    if not is_old(data):
        msg = f"{path}: is no study of the first form; nothing to change"
        raise CalibrationError(msg)
    lines = itertools.takewhile(lambda line: line.startswith("#") or not line.strip(),
                                text.splitlines())  # fmt: skip
    header = [line.removeprefix("#").removeprefix(" ") for line in lines if line.strip()]
    return document(_anew(data), "\n".join(header))


def _anew(old: Mapping[str, Any]) -> dict[str, Any]:
    """Return the tables of the present form; what is wrong in the old one stays wrong."""
    targets = tables_in(old.get("target"))
    curves = tables_in(old.get("curve"))
    surfaces = dict.fromkeys(
        one["surface"] for one in (*targets, *curves) if isinstance(one.get("surface"), str)
    )
    new: dict[str, Any] = {key: old[key] for key in ("name", "title") if key in old}
    new["run"] = {key: old[key] for key in ("scale", "engine", "seed") if key in old}
    new["design"] = {key: old[key] for key in ("check_seeds",) if key in old}
    new["material"] = [_material(old)]
    new["surface"] = [{"name": name} for name in surfaces]
    new["experiment"] = [
        {"name": name, "apparatus": values} for name, values in _table(old, "apparatus").items()
    ]
    new["target"] = [*map(_target, targets), *map(_curve, curves)]
    acting = GLUED_PARAMETERS if set(surfaces) <= {GLUED} else CONTACT_PARAMETERS
    new["parameter"] = _parameters(old, acting)
    new["known"] = {
        name: {("se" if key == "sem" else key): value for key, value in one.items()}
        for name, one in _table(old, "known").items()
        if isinstance(one, dict)
    }
    new["effects"] = _table(old, "effects")
    new["stage"] = [_stage(one) for one in tables_in(old.get("stage"))]
    return new


def _table(old: Mapping[str, Any], key: str) -> dict[str, Any]:
    value = old.get(key)
    return value if isinstance(value, dict) else {}


def _material(old: Mapping[str, Any]) -> dict[str, Any]:
    numbers = _table(old, "bulk")
    called = str(numbers.get("name", old.get("particle", "")))
    material = {"name": called.replace("/", "-"), "particle": called}
    if material["name"] == called:
        del material["particle"]
    if "particles" in old:
        material["particles"] = old["particles"]
    return {**material, **{key: value for key, value in numbers.items() if key != "name"}}


def _target(old: Mapping[str, Any]) -> dict[str, Any]:
    new = {_TARGET_KEYS.get(key, key): value for key, value in old.items()}
    if "scale" in new:
        new["scale"] = _SCALES.get(str(new["scale"]), new["scale"])
    return new


def _curve(old: Mapping[str, Any]) -> dict[str, Any]:
    keys = ("name", "label", "experiment", "surface", "file")
    columns = {
        "x_column": old.get("time_column", "time_s"),
        "column": old.get("mass_column", "mass_g"),
        "se_column": old.get("sem_column", "sem_g"),
    }
    return {key: old[key] for key in keys if key in old} | {"observable": "mass_time"} | columns


def _parameters(old: Mapping[str, Any], acting: Sequence[str]) -> dict[str, dict[str, Any]]:
    """Return ranges, values and published values by parameter.

    The first form asked for values of the wall where all walls are glued; nothing used them.
    """
    ranges = {
        name: ends for stage in tables_in(old.get("stage")) for name, ends in _free(stage).items()
    }
    tables = {"range": ranges, "value": _table(old, "fixed"), "published": _table(old, "published")}
    names = dict.fromkeys([*CONTACT_PARAMETERS, *ranges, *tables["value"]])
    return {
        name: {what: table[name] for what, table in tables.items() if name in table}
        for name in names
        if name in ranges
        or (name in tables["value"] and (name in acting or name not in CONTACT_PARAMETERS))
    }


def _free(stage: Mapping[str, Any]) -> dict[str, Any]:
    free = stage.get("free")
    return free if isinstance(free, dict) else {}


def _stage(old: Mapping[str, Any]) -> dict[str, Any]:
    return {**old, "free": list(_free(old))}
