"""Write a study file."""

from __future__ import annotations

from typing import Any, Final

from calibrate.study.model import Study
from calibrate.study.writing.toml import document

__all__ = ["study_text"]

_NAMED: Final = {"target": "label", "material": "particle", "stage": "title"}
"""Keys that are the name where nothing else is said."""


def study_text(study: Study, header: str = "") -> str:
    """Return `study` as TOML text that `load_study` reads back to an equal study.

    Parameters
    ----------
    study : Study
        Study to write.
    header : str
        Comment on top, without the comment signs.
    """
    data = study.model_dump(by_alias=True, exclude_defaults=True)
    for key, named in _NAMED.items():
        data[key] = [
            {k: v for k, v in item.items() if k != named or v != item["name"]}
            for item in data.get(key, [])
        ]
    data["surface"] = [one.model_dump() for one in study.surfaces]  # a flat one may be named glued
    data["parameter"] = {
        name: {key: _alone(value) for key, value in one.items()}
        for name, one in data.get("parameter", {}).items()
    }
    data["known"] = {
        name: listed[0] if len(listed) == 1 else listed
        for name, listed in data.get("known", {}).items()
    }
    return document(data, header)


def _alone(value: Any) -> Any:
    """Return the value that holds for all instances as it is written, without a table."""
    return value[""] if isinstance(value, dict) and set(value) == {""} else value
