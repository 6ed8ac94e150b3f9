"""The public interface: what `__all__` of these modules names, with arguments and fields.

python -m tests.house.public_api            # prints it
python -m tests.house.public_api --write    # freezes it in tests/house/public_api.txt
"""

from __future__ import annotations

import dataclasses
import importlib
import inspect
import sys
from pathlib import Path

FROZEN = Path(__file__).with_name("public_api.txt")
MODULES = ("minidem", "liggghts_io", "calibrate")


def _described(name: str, value: object) -> list[str]:
    """Return a line for a function or value, and one per public member for a class."""
    if isinstance(value, type) and issubclass(value, BaseException):
        return [f"{name}: error"]
    if dataclasses.is_dataclass(value):
        return [f"{name}.{field.name}: {field.type}" for field in dataclasses.fields(value)]
    if callable(value):
        return [f"{name}({', '.join(_arguments(inspect.signature(value)))})"]
    return [f"{name}: {type(value).__name__}"]


def _arguments(signature: inspect.Signature) -> list[str]:
    """Return the names of arguments; ``=`` marks those that may be left out, ``*`` as in a call."""
    found: list[str] = []
    for one in signature.parameters.values():
        if one.kind is one.KEYWORD_ONLY and "*" not in found:
            found.append("*")
        found.append(one.name if one.default is one.empty else f"{one.name}=")
    return found


def lines() -> list[str]:
    """Return the public interface, a line for each thing that a user may rely on."""
    found: list[str] = []
    for module_name in MODULES:
        module = importlib.import_module(module_name)
        for name in sorted(module.__all__):
            found += _described(f"{module_name}.{name}", getattr(module, name))
    return found


if __name__ == "__main__":
    text = "\n".join(lines()) + "\n"
    if "--write" in sys.argv:
        FROZEN.write_text(text, encoding="utf-8")
    else:
        sys.stdout.write(text)
