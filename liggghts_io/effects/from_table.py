"""Effects that change one number of an apparatus: a TOML file each, in `apparatus/`.

    title = "Stroke of the conveyor plate"
    meaning = "relative deviation of all amplitudes of the motion"
    unit = "-"
    experiments = ["conveyor"]
    parameter = "amplitude_factor"  # of each of these experiments
    how = "scale"                   # the number times 1 + strength; "add": plus strength
    scale = 0.03                    # ordinary strength
    low = -0.3
    high = 0.3
    settled_by = "a dial gauge at the plate, or a film of it beside a ruler"
    settled_se = 0.01               # what that measures, and the hours it takes
    settled_hours = 0.3

The name of the file is that of the effect; `scope`, `walls` and `candidate` as in `Effect`.
"""

from __future__ import annotations

import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from liggghts_io.effects.base import Effect, Prepare
from liggghts_io.errors import CaseError
from liggghts_io.experiments.setup import Setup
from liggghts_io.plug_ins import Loaded

__all__ = ["effect_of_table", "tabled_effects"]

FOLDER: Final = Path(__file__).resolve().parent / "apparatus"
_TEXTS: Final = ("title", "meaning", "unit", "settled_by")
_NUMBERS: Final = ("scale", "low", "high")
_MORE: Final = ("settled_se", "settled_hours")


def tabled_effects(folder: Path = FOLDER) -> Loaded:
    """Read the tables of a folder; a broken one is named and stops nothing."""
    loaded = Loaded({}, [])
    for path in sorted(folder.glob("*.toml")):
        try:
            one = effect_of_table(path)
        except CaseError as err:
            loaded.broken.append(f"{err}; install bulkcal again")
            continue
        loaded.found[one.name] = one
    return loaded


def effect_of_table(path: Path) -> Effect:
    """Return the effect that a TOML file describes.

    Raises
    ------
    CaseError
        With file, key and remedy.
    """
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except (OSError, ValueError) as err:
        msg = f"{path}: {err}"
        raise CaseError(msg) from err
    more: dict[str, Any] = {key: _value(path, table, key, str) for key in _TEXTS}
    numbers = [*_NUMBERS, *(key for key in _MORE if key in table)]
    more |= {key: float(_value(path, table, key, (int, float))) for key in numbers}
    how = _value(path, table, "how", str)
    if how not in ("add", "scale"):
        msg = f"{path}: how = {how!r}; give 'add' or 'scale'"
        raise CaseError(msg)
    more |= {key: table[key] for key in ("scope", "candidate") if key in table}
    return Effect(
        name=path.stem,
        prepare=_changing(_value(path, table, "parameter", str), scaled=how == "scale"),
        experiments=tuple(_value(path, table, "experiments", list)),
        walls=tuple(table.get("walls", ())),
        **more,
    )


def _value(path: Path, table: dict[str, Any], key: str, kind: Any) -> Any:
    if not isinstance(table.get(key), kind):
        msg = f"{path}: {key} = {table.get(key)!r}; see liggghts_io/effects/from_table.py"
        raise CaseError(msg)
    return table[key]


def _changing(parameter: str, *, scaled: bool) -> Prepare:
    """Return what changes one number of an apparatus."""

    def prepare(setup: Setup, strength: float) -> Setup:
        believed = setup.apparatus[parameter]
        real = believed * (1.0 + strength) if scaled else believed + strength
        return replace(setup, apparatus={**setup.apparatus, parameter: real})

    return prepare
