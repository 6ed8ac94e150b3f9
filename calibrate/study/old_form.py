"""Study files of the first form, which are refused with the command that writes them anew."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from calibrate.errors import CalibrationError
from calibrate.study.mistakes import Lines
from liggghts_io.files import shell_word

__all__ = ["refuse_old", "stem_of_new"]

_OLD_KEYS: Final = (
    "particle", "particles", "bulk", "scale", "engine", "seed", "check_seeds",
    "fixed", "published", "apparatus", "curve",
)  # fmt: skip
"""Keys at the top of the first form; the present one has tables there."""

_NEW_KEYS: Final = ("material", "surface", "run", "parameter")


def is_old(data: Mapping[str, Any]) -> bool:
    """Whether a study file has the first form."""
    return any(key in data for key in _OLD_KEYS) and not any(key in data for key in _NEW_KEYS)


def stem_of_new(path: Path) -> str:
    """Return the name that `bulkcal migrate` gives a new file where nobody says another."""
    return f"{path.stem}_new.toml"


def refuse_old(path: Path, text: str, data: Mapping[str, Any]) -> None:
    """Refuse a study of the first form.

    Raises
    ------
    CalibrationError
        With the line of the first key of that form, and the command that changes the file.
    """
    if not is_old(data):
        return
    lines = Lines(text)
    found = {key: lines.of((key,)) or 1 for key in _OLD_KEYS if key in data}
    key = min(found, key=lambda one: found[one])
    msg = (
        f"{path}:{found[key]}: '{key}' belongs to the first form of study files; change the file "
        f"with: bulkcal migrate {shell_word(path)} "
        f"{shell_word(path.with_name(stem_of_new(path)))}"
    )
    raise CalibrationError(msg)
