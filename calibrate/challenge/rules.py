"""The rules of a suite: how many studies of which kind, and how they are drawn and judged."""

from __future__ import annotations

import hashlib
import tomllib
from pathlib import Path
from typing import Annotated, Final, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from calibrate.errors import CalibrationError

__all__ = ["KINDS", "Rules", "load_rules", "rng_of"]

KINDS: Final = ("nothing", "single", "pair", "foreign")
"""Kinds of studies, in the order in which they are drawn."""
_Count = Annotated[int, Field(ge=0, le=100_000)]


class Rules(BaseModel):
    """The rules of a suite.

    Attributes
    ----------
    name : str
    study : str
        Study file beside the rules: what is measured, and the ranges of the parameters.
    runs : str or list of str
        Tables of runs beside the rules: its design, without causes and with each. Who forecasts
        learns from them; a laboratory's parameters are drawn from the whole ranges.
    nothing, single, pair, foreign : int
        How many studies of each kind.
    repeats : int
        Runs behind each measured value, each with a seed of its own.
    errors : {"design", "runs"}
        How the laboratory tells the errors of its values: as single runs of the design scatter, a
        curve with an error that all of its levels share; or as its own runs do, as far as so few
        can tell, a curve level by level.
    noncentrality : list of float
        Strengths in standard errors of what the parameters cannot imitate; they take turns.
    imitation : {"near", "anywhere"}
        Which parameters may imitate: those near the true ones, along straight lines, as the theory
        has it; or any in their ranges.
    from_prior : float
        Share of the causes whose strength is drawn from the stated prior instead.
    other_numerics : float
        Share of the studies whose runs have another time step, width or side wall.
    liggghts : float
        Share of the studies whose runs LIGGGHTS makes, where it knows their causes.
    fresh : float
        Share of the studies with a cause whose experiments are made once more with other seeds,
        to see what a cause really gains.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    name: str
    study: str
    runs: str | list[str]
    nothing: _Count = 0
    single: _Count = 0
    pair: _Count = 0
    foreign: _Count = 0
    repeats: Annotated[int, Field(ge=1, le=1000)] = 4
    errors: Literal["design", "runs"] = "design"
    noncentrality: list[Annotated[float, Field(gt=0.0)]] = [1.4, 2.8, 5.6, 11.0]
    imitation: Literal["near", "anywhere"] = "near"
    from_prior: Annotated[float, Field(ge=0.0, le=1.0)] = 0.5
    other_numerics: Annotated[float, Field(ge=0.0, le=1.0)] = 0.2
    liggghts: Annotated[float, Field(ge=0.0, le=1.0)] = 0.05
    fresh: Annotated[float, Field(ge=0.0, le=1.0)] = 0.25

    @property
    def tables(self) -> list[str]:
        """Tables of runs, one or more."""
        return [self.runs] if isinstance(self.runs, str) else self.runs

    @property
    def count(self) -> int:
        """How many studies there are."""
        return sum(getattr(self, kind) for kind in KINDS)

    def kinds(self) -> list[str]:
        """Return the kind of every study, mixed evenly, so that the first ones have all kinds."""
        places = [
            ((k + 0.5) / getattr(self, kind), kind)
            for kind in KINDS
            for k in range(getattr(self, kind))
        ]
        return [kind for _, kind in sorted(places)]


def load_rules(path: Path) -> Rules:
    """Read the rules of a suite from a TOML file.

    Raises
    ------
    CalibrationError
        With file and key.
    """
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except (OSError, ValueError) as err:
        why = getattr(err, "strerror", None) or err
        msg = f"{path}: {why}; rules are a TOML file such as cases/challenge/dev.toml"
        raise CalibrationError(msg) from err
    try:
        return Rules.model_validate(table)
    except ValidationError as err:
        first = err.errors()[0]
        key = ".".join(str(part) for part in first["loc"])
        msg = f"{path}: {key}: {first['msg']}"
        raise CalibrationError(msg) from err


def rng_of(seed: str, number: int) -> np.random.Generator:
    """Return the generator of one study, from the text that seeds the suite.

    Parameters
    ----------
    seed : str
        Such as the id of the commit that holds the rules.
    number : int
        Of the study.
    """
    digest = hashlib.sha256(f"{seed}/{number}".encode()).digest()
    return np.random.default_rng(int.from_bytes(digest[:16], "big"))
