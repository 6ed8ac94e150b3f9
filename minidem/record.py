"""Classes of plain data: data classes without the methods that nothing asks of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, fields, replace
from typing import TYPE_CHECKING, Any

__all__ = ["field", "fields", "record", "replace"]

if TYPE_CHECKING:
    from dataclasses import dataclass as record  # so that fields, and frozen ones, are checked
else:

    def record(
        cls: type | None = None, /, *, frozen: bool = False, kw_only: bool = False
    ) -> type | Callable[[type], type]:
        """Make a data class that has no more than its constructor.

        ``dataclass`` compiles every method from text whenever a program starts: comparison, text
        and refusal to change take three quarters of that, and nothing compares, prints or changes
        records. So they are compared as objects are, and that a `frozen` one does not change is
        checked with the types. A class that adds no field to its base needs no decorator at all.

        Parameters
        ----------
        cls : type
            The class.
        frozen : bool
            Whether no field may be set once it is made.
        kw_only : bool
            Whether the fields are given by name.
        """
        del frozen  # mypy
        make: Any = dataclass(eq=False, repr=False, kw_only=kw_only)
        return make if cls is None else make(cls)
