"""Base of all fixes."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Fix"]


@dataclass
class Fix:
    """One ``fix`` command.

    Attributes
    ----------
    name : str
        Its id in the script.
    style : str
        Style as written.
    bit : int
        Group bit.
    """

    name: str
    style: str
    bit: int

    def vector(self, index: int) -> float:
        """Return ``f_ID[index]``, index from 1; 0 is the scalar ``f_ID``.

        Raises
        ------
        KeyError
            If this fix has no such value.
        """
        msg = f"fix {self.style} has no value [{index}]"
        raise KeyError(msg)
