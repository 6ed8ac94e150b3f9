"""The fixes of a script by name; which of them are of a class is looked up once."""

from __future__ import annotations

from collections import UserDict
from typing import Any, TypeVar

__all__ = ["Roster"]

T = TypeVar("T")


class Roster(UserDict[str, Any]):
    """Fixes in the order of the script.

    The run loop asks for those of a class whenever new lists are made, and they change between
    runs only.
    """

    def __init__(self) -> None:
        self._kinds: dict[type, list[Any]] = {}
        super().__init__()

    def __setitem__(self, name: str, fix: Any) -> None:
        """Enter a fix."""
        self._kinds.clear()
        self.data[name] = fix

    def __delitem__(self, name: str) -> None:
        """Strike a fix off."""
        self._kinds.clear()
        del self.data[name]

    def of_kind(self, kind: type[T]) -> list[T]:
        """Return the fixes of a class in the order of the script."""
        found = self._kinds.get(kind)
        if found is None:
            found = [fix for fix in self.data.values() if isinstance(fix, kind)]
            self._kinds[kind] = found
        return list(found)
