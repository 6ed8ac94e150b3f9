"""A study's tables as TOML text, in the order in which a person would write them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any, Final

__all__ = ["document", "setting"]

_ORDER: Final = (
    "run", "design", "likelihood", "material", "surface", "experiment", "target", "shared",
    "parameter", "known", "effects", "stage",
)  # fmt: skip
_BARE: Final = re.compile(r"[A-Za-z0-9_-]+")


def document(data: Mapping[str, Any], header: str = "") -> str:
    """Return the tables of a study as TOML text.

    Parameters
    ----------
    data : mapping
        Tables by key, as a study file has them; empty ones are left out.
    header : str
        Comment on top, without the comment signs.
    """
    lines = [f"# {line}".rstrip() for line in header.splitlines()]
    lines += _settings({key: value for key, value in data.items() if key not in _ORDER})
    for key in _ORDER:
        value = data.get(key)
        if key == "parameter":
            for name, one in (value or {}).items():
                lines += ["", f"[parameter.{_key(name)}]", *_settings(one)]
        elif isinstance(value, list):
            for item in value:
                lines += ["", f"[[{key}]]", *_settings(item)]
        elif value:
            lines += ["", f"[{key}]", *_settings(value)]
    return "\n".join(lines) + "\n"


def _settings(values: Mapping[str, Any]) -> list[str]:
    return [setting(name, value) for name, value in values.items()]


def setting(name: str, value: object) -> str:
    """Return a line that sets a key.

    Examples
    --------
    >>> setting("scale", "quick"), setting("a.b", [1, 2])
    ('scale = "quick"', '"a.b" = [1, 2]')
    """
    return f"{_key(name)} = {_value(value)}"


def _key(name: str) -> str:
    return name if _BARE.fullmatch(name) else _value(name)


def _value(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        escaped = value.replace("\\", "\\\\").replace('"', '\\"')
        plain = "".join(c if c.isprintable() else f"\\U{ord(c):08x}" for c in escaped)
        return f'"{plain}"'
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_value(one) for one in value) + "]"
    if isinstance(value, dict):
        return "{ " + ", ".join(_settings(value)) + " }" if value else "{}"
    return repr(value)
