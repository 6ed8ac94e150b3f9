"""One study of a suite with what is true of it and what was said of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

__all__ = ["Case"]


@dataclass(frozen=True)
class Case:
    """A study with what is true of it and what was said of it.

    Attributes
    ----------
    truth : dict
        As `calibrate.challenge.truths.Truth.plain` gives it.
    forecast : dict or None
        None where a method failed: it gets the floor.
    away : float
        How far the data lie from the base model at the true parameters, in standard errors that
        the parameters cannot imitate.
    beyond : float
        The same, of what no single cause of the library can imitate either.
    gained : float or None
        Log density that the claimed cause really gains on new data.
    unlike : float
        How far what the cause does is from the base model at any parameters, in standard errors;
        nan where nobody asks.
    tested : float
        How often a test of level 0.05 of all that the causes of the library leave would object.
    """

    truth: Mapping[str, Any]
    forecast: Mapping[str, Any] | None
    away: float = float("nan")
    beyond: float = float("nan")
    gained: float | None = None
    unlike: float = float("nan")
    tested: float = float("nan")

    @property
    def kind(self) -> str:
        """Kind of the study."""
        return str(self.truth["kind"])

    @property
    def hidden(self) -> list[str]:
        """Causes that act."""
        return [one["name"] for one in self.truth["hidden"]]

    @property
    def size(self) -> float:
        """Non-centrality of the weakest cause."""
        return min((one["noncentrality"] for one in self.truth["hidden"]), default=float("nan"))

    @property
    def names(self) -> list[str]:
        """Causes that the verdict names."""
        return list(self.forecast["names"]) if self.forecast else []

    @property
    def verdict(self) -> str:
        """Kind of the verdict."""
        return str(self.forecast["verdict"]) if self.forecast else "failed"

    def probability(self, name: str) -> float:
        """Return the stated probability that a cause acts."""
        return float(self.forecast["inclusion"].get(name, 0.0)) if self.forecast else 0.0
